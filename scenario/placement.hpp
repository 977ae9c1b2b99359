#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/model/arm.hpp"
#include "multibody/rigid_body.hpp"
#include "multibody/spatial.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

/// A frame that things may be attached to: what carries it, and where it stands at the start.
struct PlacedFrame {
  coupling::MotionCarrier carrier;
  multibody::Pose X_WF;
};

/// Where a body stands.
[[nodiscard]] inline multibody::Pose pose_of(const multibody::RigidBodyState& s) {
  return {s.orientation.toRotationMatrix(), s.position};
}

/// Finds out where everything of a scenario stands at the start: things stand on frames that other things
/// bring, in any order in the file.
class Placement {
 public:
  /// Places a thing on its frame: told the frame, adds its own frames.
  using Place = std::function<void(const PlacedFrame& on, Placement& placement)>;

  Placement();
  /// A thing that stands on the frame under a key of a table ("world" where the key is missing), and brings
  /// frames of which the names are `own` or begin with `own` and "::".
  void stand(const base::TomlTable& table, std::string key, std::string own, Place place);
  /// Places all that stands on something; loops and unknown names are reported.
  void resolve();
  /// A frame that is placed. A name that is taken is kept as it was.
  void add(const std::string& name, const PlacedFrame& frame);

  /// What brings frames of this name, or of names that begin with it and "::", has failed: they are not
  /// reported as missing.
  void excuse(const std::string& own) { excused_.push_back(own); }

  /// Whether `excuse` was told of what brings this name.
  [[nodiscard]] bool is_excused(const std::string& name) const;

  /// The frame under a key of a table, "world" where it is missing: all must be resolved. Nothing after a
  /// problem.
  [[nodiscard]] std::optional<PlacedFrame> frame(const base::TomlTable& table, std::string_view key) const;
  [[nodiscard]] std::optional<PlacedFrame> find(const std::string& name) const;
  [[nodiscard]] std::string requirement() const;

 private:
  struct Waiting {
    base::TomlTable table;
    std::string key, on, own;
    Place place;
  };
  [[nodiscard]] bool brings(const Waiting& waiting, const std::string& name) const;

  std::map<std::string, PlacedFrame> frames_;
  std::vector<std::string> excused_;
  std::vector<Waiting> waiting_;
};

}  // namespace snare::scenario
