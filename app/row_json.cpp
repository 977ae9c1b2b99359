#include "app/row_json.hpp"

#include <nlohmann/json.hpp>

namespace snare::app {

nlohmann::json row_json(const validation::Row& row) {
  return {{"group", row.group},
          {"name", row.name},
          {"unit", row.unit},
          {"source", row.source},
          {"kind", validation::key_of(row.kind)},
          {"reference", row.reference},
          {"value", row.value},
          {"error", row.error()},
          {"error_kind", row.limit.error_kind() == validation::ErrorKind::relative ? "relative" : "absolute"},
          {"limit", row.limit.value()},
          {"limit_reason", row.limit.reason()},
          {"verdict", row.within() ? "within" : "out"}};
}

}  // namespace snare::app
