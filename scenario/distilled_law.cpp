#include "scenario/distilled_law.hpp"

#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/units.hpp"
#include "coupling/contact/ranged_law.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace snare::scenario {

namespace {

using base::mm;
using nlohmann::json;

constexpr std::size_t size_limit = 1u << 30u;  // of a law.json [byte]

/// A place in the file, with its address for messages.
class Field {
 public:
  Field(const std::string& file, const json& value, std::string address)
      : file_(&file), value_(&value), address_(std::move(address)) {}

  [[noreturn]] void fail(const std::string& requirement) const {
    std::string written = value_->dump();
    if (written.size() > 40) written = written.substr(0, 37) + "...";
    throw base::InputError(base::InputProblem{*file_, 0, address_, written, requirement});
  }
  [[nodiscard]] bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  [[nodiscard]] Field operator[](const char* key) const {
    const std::string address = address_.empty() ? key : address_ + "." + key;
    if (!has(key)) throw base::InputError(base::InputProblem{*file_, 0, address, "", "missing"});
    return {*file_, (*value_)[key], address};
  }
  [[nodiscard]] std::vector<Field> items() const {
    if (!value_->is_array()) fail("must be an array");
    std::vector<Field> all;
    for (std::size_t k = 0; k < value_->size(); ++k)
      all.emplace_back(*file_, (*value_)[k], fmt::format("{}[{}]", address_, k + 1));
    return all;
  }
  [[nodiscard]] bool is_null() const { return value_->is_null(); }
  [[nodiscard]] double number() const {
    if (!value_->is_number() || !std::isfinite(value_->get<double>())) fail("must be a number");
    return value_->get<double>();
  }
  [[nodiscard]] double positive() const {
    const double value = number();
    if (!(value > 0.0)) fail("must be > 0");
    return value;
  }
  [[nodiscard]] bool boolean() const {
    if (!value_->is_boolean()) fail("must be true or false");
    return value_->get<bool>();
  }
  [[nodiscard]] std::string text() const {
    if (!value_->is_string()) fail("must be a text");
    return value_->get<std::string>();
  }
  [[nodiscard]] std::vector<double> numbers() const {
    if (!value_->is_array()) fail("must be an array of numbers");
    std::vector<double> all;
    all.reserve(value_->size());
    for (const json& one : *value_) {
      if (!one.is_number() || !std::isfinite(one.get<double>())) fail("must be an array of numbers");
      all.push_back(one.get<double>());
    }
    return all;
  }
  /// From, to.
  [[nodiscard]] std::array<double, 2> interval(double unit) const {
    const std::vector<double> ends = numbers();
    if (ends.size() != 2 || ends[0] > ends[1]) fail("must be two numbers, the lower one first");
    return {ends[0] * unit, ends[1] * unit};
  }

 private:
  const std::string* file_;
  const json* value_;
  std::string address_;
};

std::vector<double> knots_of(const Field& field, std::size_t least) {
  std::vector<double> knots = field.numbers();
  if (knots.size() < least || !std::ranges::is_sorted(knots, std::less_equal<>()))
    field.fail(fmt::format("must be {} or more numbers, each greater than the one before", least));
  return knots;
}

coupling::ForceTable table_of(const Field& table, const Field& nodes) {
  const coupling::ForceTable::Axes axes{knots_of(table["travel"], 2), knots_of(table["position"], 1),
                                        knots_of(table["slack"], 1)};
  std::vector<double> numbers = nodes.numbers();
  const std::size_t wanted =
      coupling::ForceTable::numbers_a_node * axes[0].size() * axes[1].size() * axes[2].size();
  if (numbers.size() != wanted) nodes.fail(fmt::format("must be {} numbers, eight a node", wanted));
  return coupling::ForceTable::from_nodes(axes, std::move(numbers), table["span_m"].positive(),
                                          table["force_scale_N"].positive(), table["mirrored"].boolean());
}

coupling::LawFormPointer form_of(const std::string& name, const coupling::LawPlace& place) {
  const std::vector<coupling::LawFormPointer> forms = coupling::law_forms(place);
  const auto form = std::ranges::find_if(forms, [&](const auto& f) { return f->name() == name; });
  return form == forms.end() ? nullptr : *form;
}

SimpleLaw read_simple_law(const Field& entry, const coupling::LawPlace& place) {
  const std::string name = entry["name"].text();
  const coupling::LawFormPointer form = form_of(name, place);
  if (form == nullptr) entry["name"].fail("must be the name of a law that this version knows");
  const std::array<double, 2> travel = entry["travel_mm"].interval(mm);
  if (!(travel[1] > 0.0)) entry["travel_mm"].fail("must end above 0");
  std::vector<double> values;
  for (const coupling::LawParameter& p : form->parameters())
    values.push_back(entry["parameters"][p.name.c_str()]["value"].number());
  SimpleLaw one = make_simple_law(name, place, std::move(values), travel);
  one.formula = entry["formula"].text();
  one.largest_error = entry["error"]["largest_force_N"].number();
  return one;
}

DistilledLoss read_loss(const Field& at) {
  DistilledLoss loss;
  loss.position = at["position_mm"].number() * mm;
  if (at.has("load_unload")) {
    const Field loop = at["load_unload"];
    loss.loop = {loop["returned"].number(), loop["turn_mm"].positive() * mm, loop["loop_J"].number()};
    if (!(loss.loop->returned >= 0.0 && loss.loop->returned <= 1.0))
      loop["returned"].fail("must be from 0 to 1");
  }
  if (!at.has("impacts")) return loss;
  for (const Field& impact : at["impacts"].items()) {
    if (loss.dashpot || impact["damping_Ns_m"].is_null()) continue;
    loss.dashpot = {impact["speed_m_s"].positive(), impact["restitution"].number(),
                    impact["damping_Ns_m"].number()};
    if (!(loss.dashpot->damping >= 0.0)) impact["damping_Ns_m"].fail("must be >= 0");
  }
  return loss;
}

DistilledLaw law_of(const Field& entry, const std::string& title) {
  DistilledLaw law;
  law.title = title;
  const Field table = entry["table"];
  law.loading = std::make_shared<const coupling::ForceTable>(table_of(table, table["nodes"]));
  if (table.has("unloading"))
    law.unloading =
        std::make_shared<const coupling::ForceTable>(table_of(table, table["unloading"]["nodes"]));
  law.bound = table["error"]["bound_N"].number();
  law.force_range = table["error"]["force_range_N"].number();
  const Field wire = entry["wire"];
  const Field ranges = entry["ranges"];
  law.travel = ranges["travel_mm"].interval(mm);
  law.position = ranges["position_mm"].interval(mm);
  law.slack = ranges["slack_mm"].interval(mm);
  coupling::LawPlace place;
  place.span = wire["span_mm"].positive() * mm;
  place.length = wire["length_mm"].positive() * mm;
  place.bending_stiffness = wire["bending_stiffness_Nm2"].positive();
  law.nominal_slack = place.length - place.span;
  law.wire = {place.bending_stiffness, wire["axial_stiffness_N"].positive(), place.span,
              wire["radius_mm"].number() * mm};
  for (const Field& at : entry["positions"].items()) {
    place.position = at["position_mm"].number() * mm;
    law.losses.push_back(read_loss(at));
    for (const Field& one : at["laws"].items()) law.simple.push_back(read_simple_law(one, place));
  }
  return law;
}

void check_finite(double d, double s, double e) {
  if (!(std::isfinite(d) && std::isfinite(s) && std::isfinite(e)))
    throw std::domain_error(fmt::format("travel {} m, position {} m, slack {} m: must be finite", d, s, e));
}

}  // namespace

std::vector<coupling::LawParameter> parameters_of_law(const std::string& name) {
  const coupling::LawFormPointer form = form_of(name, {1.0, 0.5, 1.0, 1.0});
  return form == nullptr ? std::vector<coupling::LawParameter>() : form->parameters();
}

SimpleLaw make_simple_law(const std::string& name, const coupling::LawPlace& place,
                          std::vector<double> values, std::array<double, 2> travel) {
  const coupling::LawFormPointer form = form_of(name, place);
  SimpleLaw one;
  one.position = place.position;
  one.place = place;
  one.name = name;
  one.formula = form->formula();
  one.parameters = form->parameters();
  one.values = std::move(values);
  one.travel = travel;
  one.law = std::make_shared<const coupling::RangedLaw>(
      form->with(
          Eigen::Map<const Eigen::VectorXd>(one.values.data(), static_cast<Eigen::Index>(one.values.size()))),
      travel[1]);
  return one;
}

bool DistilledLaw::in_range(double d, double s, double e) const noexcept {
  const double span = loading->span();
  const double margin = 1e-9 * span;
  const auto within = [&](double x, const std::vector<double>& knots) {
    return x >= knots.front() * span - margin && x <= knots.back() * span + margin;
  };
  const auto& axes = loading->axes();
  const double near = loading->mirrored() ? std::min(s, span - s) : s;
  return d < 0.0 || (within(d, axes[0]) && within(near, axes[1]) && within(e, axes[2]));
}

coupling::LawValue DistilledLaw::at(const coupling::ForceTable& table, double d, double s, double e,
                                    coupling::Outside outside) {
  check_finite(d, s, e);
  return table.at(d, s, e, outside);
}

ContinuedForce DistilledLaw::force(const coupling::ForceTable& table, double d, double s, double e,
                                   coupling::Outside outside) {
  const auto& axes = table.axes();
  const double span = table.span();
  const double near = table.mirrored() && s > 0.5 * span ? span - s : s;
  const auto inside = [span](double x, const std::vector<double>& knots) {
    return x >= knots.front() * span && x <= knots.back() * span;
  };
  if (inside(d, axes[0]) && inside(near, axes[1]) && inside(e, axes[2])) return {table.force(d, s, e), false};
  const coupling::LawValue value = at(table, d, s, e, outside);
  return {value.force, value.extrapolated};
}

std::vector<DistilledLaw> read_law_file(const std::filesystem::path& file) {
  return read_laws(file.string(), json::parse(base::read_text(file, size_limit), nullptr, false));
}

std::vector<DistilledLaw> read_laws(const std::string& name, const json& document) {
  if (!document.is_object())
    throw base::InputError(base::InputProblem{name, 0, "", "", "must be JSON, an object"});
  const Field top(name, document, "");
  if (const Field schema = top["schema"]; schema.text() != "snare-law/1")
    schema.fail("must be \"snare-law/1\": the law.json of `snare distil`");
  std::vector<DistilledLaw> laws;
  for (const Field& one : top["cases"].items()) laws.push_back(law_of(one, top["title"].text()));
  if (laws.empty()) top["cases"].fail("must have one case at least");
  return laws;
}

}  // namespace snare::scenario
