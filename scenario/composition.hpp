#pragma once

#include "base/toml_reader.hpp"
#include "scenario/list_items.hpp"
#include "scenario/names.hpp"
#include "scenario/placement.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace snare::scenario {

/// A joint with a motor, of an arm or a snare.
struct MotorJoint {
  int arm = 0;          ///< index among the arms of the motion
  int joint = 0;        ///< index among its elastic joints
  bool slides = false;  ///< its coordinate is a length [m]
};

/// The wires of a snare, and how its ring turns about z.
struct SnareWires {
  std::vector<int> wires;
  double sense = 1.0;  ///< +1: to the left about its z, -1: to the right [-]
};

/// A shape of the list, for contacts of bodies.
struct PlacedShape {
  base::TomlTable table;
  PlacedFrame on;  ///< of the shape's own frame
  std::shared_ptr<const coupling::ContactShape> shape;
};

/// A composed scenario while it is read: what there is so far, by name.
struct Composition {
  base::TomlDocument& document;
  std::filesystem::path folder;
  std::map<std::string, std::vector<base::Override>> arm_overrides =
      {};  ///< of the arms' own files, by the arms' names
  coupling::Motion motion = {};
  Placement placement = {};
  wire::RodDamping damping = {};
  double strand_time = wire::RodStrands{}.time;  ///< [s]
  std::vector<DeclaredWire> wires = {};          ///< those of the motion, before they are at rest
  std::string input = {};                        ///< fingerprints of other files
  Names wire_names{"wire"}, body_names{"body"}, arm_names{"arm"}, shape_names{"shape"}, pair_names{"contact"};
  std::map<std::string, MotorJoint> joints = {};  ///< "ARM::JOINT", "SNARE::ring", "SNARE::carriage"
  std::map<std::string, SnareWires> snares = {};
  std::map<std::string, PlacedShape> shapes = {};
  std::vector<std::string> model_keys = {};  ///< of the wires
  std::set<std::string> law_models = {};     ///< of which a wire has the numbers
  std::vector<DrawnLines> drawn = {};
  std::vector<std::string> warnings = {};  ///< about what is read as it stands and likely meant otherwise

  /// The joint under a key, reported when there is none.
  [[nodiscard]] const MotorJoint* joint(const base::TomlTable& table, std::string_view key) const;
  /// Where results count a wire, by where it is declared: those that laws stand for behind the others.
  [[nodiscard]] int counted(int declared) const;
  /// Indices of the contact and of the wire under a key, as results count them; 0 where there is none, which
  /// is reported.
  [[nodiscard]] int contact(const base::TomlTable& table, std::string_view key) const;
  [[nodiscard]] int contact(const base::TomlTable& table, std::string_view key,
                            const std::string& name) const;
  [[nodiscard]] int wire(const base::TomlTable& table, std::string_view key) const;
  /// A body on which a shape or a weld may sit where a frame is: that of the frame, a light one of this mass
  /// [kg] welded to an arm's, or one at rest.
  int body_on(const PlacedFrame& frame, const std::string& name, double mass);
  /// Adds a shape on its frame, in contact with the declared wires of these indices, but for those that laws
  /// stand for. mass [kg]: as of body_on.
  void add_shape(const std::string& name, const coupling::MotionContact& shape, const PlacedFrame& frame,
                 double mass, const std::vector<int>& on);
};

}  // namespace snare::scenario
