#include "scenario/arm_reader.hpp"

#include "base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace snare::scenario {

using base::degree;
using base::Range;
using base::TomlTable;

Eigen::VectorXd read_pose(const TomlTable& root, std::string_view name_key, std::string_view angles_key,
                          const multibody::ArmDescription& arm) {
  const auto n = static_cast<Eigen::Index>(arm.joints.size());
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(n);
  if (root.has(angles_key)) {
    if (root.has(name_key)) root.fail(angles_key, fmt::format("cannot stand beside {}", name_key));
    const auto count = static_cast<std::size_t>(n);
    const std::vector<double> given =
        root.numbers(angles_key, count, count, Range::from(-3600.0, 3600.0), degree);
    if (given.size() == count) angles = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
    return arm.with_flexures(angles);
  }
  const std::string name = root.text(name_key);
  const auto at = std::find_if(arm.poses.begin(), arm.poses.end(),
                               [&](const multibody::ArmPose& p) { return p.name == name; });
  if (at != arm.poses.end()) return at->angles;
  std::string known;
  for (const multibody::ArmPose& p : arm.poses)
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", p.name);
  root.fail(name_key, "must be a pose of the arm: " + known);
  return arm.with_flexures(angles);
}

}  // namespace snare::scenario
