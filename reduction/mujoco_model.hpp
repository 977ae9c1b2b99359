#pragma once

#include "reduction/mujoco_text.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::reduction {

/// Where and how a body of a user's model meets the wire.
struct MujocoMeeting {
  std::string body;  ///< name in the model
  /// Of the push, in the frame of the body; none: that of its slide joint, else y.
  std::optional<Eigen::Vector3d> axis;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< that meets the wire, in the frame of the body [m]
  double advance = 0.0;                             ///< travel from the model's pose to first touch [m], >= 0
};

/// A user's model with a law on one of its bodies.
struct MujocoModel {
  std::string text;                ///< the model with the law
  bool fixed = true;               ///< by a tendon on the body's slide joint; false: by one from a far site
  std::vector<std::string> notes;  ///< limits of this attachment, for the user
};

/// A model of MuJoCo (MJCF) that a law can be put into. Files that it includes are read, too.
class MujocoTarget {
 public:
  /// Throws InputError for a file that is not MJCF, and for an included file that cannot be read.
  explicit MujocoTarget(const std::filesystem::path& file);

  /// Names of its bodies, in the order of the file.
  [[nodiscard]] std::vector<std::string> bodies() const;

  /// The model with the tendons of a law on a body, for a file in the folder `out`: meshes and textures are
  /// named from there. A body whose only joint is a slide joint gets fixed tendons on it; another moving body
  /// gets spatial tendons from a site 10 km behind it, and no sliders and no damper. Throws InputError for an
  /// unknown body (with those that there are), one that does not move, an axis across the only slide joint,
  /// and a model that has this law already.
  [[nodiscard]] MujocoModel with(const MujocoLaw& law, MujocoForm form, const MujocoMeeting& meeting,
                                 const std::filesystem::path& out) const;

 private:
  struct Parts;
  std::filesystem::path file_;
  std::string text_;  ///< with the included files in place
};

}  // namespace snare::reduction
