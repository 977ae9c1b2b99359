#pragma once

#include "reduction/mujoco_law.hpp"

#include <array>
#include <string>
#include <vector>

namespace snare::reduction {

/// Forms of a law for MuJoCo and for the programs that read its files.
enum class MujocoForm {
  law,    ///< the curve by pieces, and the dashpot of an impact; MuJoCo 3.7.0 and later, MuJoCo Warp
  loop,   ///< the curve with a friction loop by slipping tendons; MuJoCo 4.0.0 and later
  linear  ///< one number a position; also MJX and MuJoCo before 3.7.0
};
inline constexpr std::array<MujocoForm, 3> mujoco_forms{MujocoForm::law, MujocoForm::loop,
                                                        MujocoForm::linear};

/// Name of the file of a form: law_mujoco.xml, law_mujoco_loop.xml, law_mujoco_linear.xml.
[[nodiscard]] const char* file_of(MujocoForm form);
/// The programs that read a form, with their versions, for the head of its file.
[[nodiscard]] const char* readers_of(MujocoForm form);
/// Whether a law has this form: only a law with a friction loop has that of a loop.
[[nodiscard]] bool has_form(const MujocoLaw& law, MujocoForm form);

/// Distance of the far site of a spatial tendon [m]: a body that moves 0.1 m across the push changes its
/// length by 0.5 um.
inline constexpr double mujoco_far_site = 1e4;

/// How a law's tendons are tied to a body of a model.
struct MujocoTie {
  std::string name;          ///< begins the names of all parts, an identifier
  std::string joint;         ///< slide joint of a fixed tendon; empty: a spatial tendon from a far site
  double coefficient = 1.0;  ///< of the joint, -1 where its axis is opposed to the push
  double first_touch = 0.0;  ///< length of the tendon at first touch [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< of the push, in the frame of the body, of length one
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< of the body that meets the wire, in its frame [m]
  double advance = 0.0;  ///< travel of the body from the pose of the model to first touch [m]
};

/// Elements of <tendon> for one law, two spaces before every line.
[[nodiscard]] std::string mujoco_tendons(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie);
/// Sites that stay where they are, in the frame of the body before it moves; empty where the form needs none.
[[nodiscard]] std::string mujoco_anchors(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie);
/// What the body itself carries: a pin without mass and collisions, and its side site; empty where the form
/// needs none.
[[nodiscard]] std::string mujoco_pin(const MujocoLaw& law, MujocoForm form, const MujocoTie& tie);
/// One line on the law in this form: range, error, loss; no double hyphen in it.
[[nodiscard]] std::string mujoco_words(const MujocoLaw& law, MujocoForm form);

/// A model with a body of its own for every law, with a slide joint along y, heavy enough for MuJoCo's
/// default step. Laws that have not this form are left out.
[[nodiscard]] std::string mujoco_file(const std::vector<MujocoLaw>& laws, MujocoForm form,
                                      const std::string& title);

}  // namespace snare::reduction
