#pragma once

#include "base/index.hpp"
#include "base/toml_reader.hpp"
#include "multibody/arm/elastic_arm.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::scenario {

/// What the drives of an arm do: what its file says, nothing, or keep their motors where they stand.
enum class Hold { as_described, limp, locked };

/// The words of the key `hold`.
inline constexpr base::Choice<Hold> holds[] = {
    {"as_described", Hold::as_described}, {"limp", Hold::limp}, {"locked", Hold::locked}};

/// Drives that stand at these angles of the arm's joints [rad], one a drive. Links bend about hinges that
/// stay as they are.
inline void hold(Hold how, const Eigen::VectorXd& angles, const multibody::ElasticArm& arm,
                 std::vector<multibody::Drive>& drives) {
  for (int k = 0; k < static_cast<int>(drives.size()); ++k) {
    multibody::Drive& drive = drives[base::at(k)];
    if (how == Hold::limp && !arm.joints[base::at(k)].flexure) drive = multibody::Drive::limp();
    if (how == Hold::locked) drive = multibody::Drive::locked();
    drive.course = multibody::Course::standing(angles[k]);
  }
}

}  // namespace snare::scenario
