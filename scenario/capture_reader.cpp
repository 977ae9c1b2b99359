#include "scenario/capture_reader.hpp"

#include <fmt/format.h>

namespace snare::scenario {

using base::Range;
using base::TomlTable;

std::optional<CaptureTest> read_capture(const Composition& c) {
  const TomlTable root = c.document.root();
  if (!root.has("capture")) return std::nullopt;
  const TomlTable table = root.table("capture");
  CaptureTest test;
  const std::string snare = table.text("snare");
  const auto known = c.snares.find(snare);
  if (known == c.snares.end()) {
    std::string list;
    for (const auto& [name, one] : c.snares) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
    if (!snare.empty())
      table.fail("snare", list.empty() ? "must be a snare; there is none" : "must be a snare: " + list);
  } else {
    for (const int declared : known->second.wires) test.wires.push_back(c.counted(declared));
    test.sense = known->second.sense;
    test.snare = c.placement.find(snare + "::fixed").value_or(PlacedFrame{});
  }
  static_cast<void>(table.text("shaft_frame"));
  test.shaft = c.placement.frame(table, "shaft_frame").value_or(PlacedFrame{});
  test.speed = table.number_or("speed_m_s", test.speed, Range::above(0.0, 1e3));
  test.hold = table.number_or("hold_s", test.hold, Range::from(0.0, 1e6));
  return test;
}

}  // namespace snare::scenario
