#pragma once

#include "base/toml_reader.hpp"
#include "coupling/dynamics/model/centre_line.hpp"
#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/run/pressed_start.hpp"
#include "scenario/mount_reader.hpp"
#include "scenario/names.hpp"
#include "scenario/placement.hpp"
#include "scenario/push_law.hpp"
#include "wire/specification.hpp"

#include <Eigen/Core>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

/// The items of a scenario's lists that stand for themselves: wires, bodies, shapes, contacts of wires. Keys,
/// units and ranges in docs/scenario_file.md; what is wrong is reported to the tables' document.

/// A wire as it stands in the file; its shape at rest is found when all of the file is known to be right.
struct DeclaredWire {
  wire::WireSpecification specification;
  coupling::MotionWire wire;
  WireMounts mounts;
  /// Of the ends and of the slack, in the world at the start.
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::UnitX(),
                  bulge = Eigen::Vector3d::UnitY();
  double span = 0.0;                     ///< [m]
  std::optional<coupling::LawWire> law;  ///< stands for it
  std::optional<PushModel> push;         ///< of a law of pushes
  /// What carries the ends; the world: they stand still.
  coupling::MotionCarrier from_carrier, to_carrier;
  /// Of the housing about it, its centre in the world: along its axis where the wire is or not.
  std::optional<coupling::RoundWall> wall;
  /// In the world, on which it begins; none: at rest between its mounts.
  std::optional<coupling::CentreLine> line;
};

/// The wire for which a law stands, in its place but without a shaft.
[[nodiscard]] coupling::LawWire law_in_place(const DeclaredWire& wire);

/// Construction, mesh, mounts' kind, strength and tightness of a wire: all but its place. Damping is that of
/// all wires. beside: of a wire that laws of pushes may stand for. natural_length: of one that may leave its
/// length out [m].
[[nodiscard]] DeclaredWire read_wire_item(const base::TomlTable& table, const wire::RodDamping& damping,
                                          wire::SpatialEnd::Kind mount,
                                          const std::optional<BesideScenario>& beside = {},
                                          std::optional<double> natural_length = {});
/// Sets the constants of the rod from all that is declared of it; its mounts a span [m] apart.
void set_rod(DeclaredWire& wire, double span);
/// Sets place and span, with the direction of the slack, and reports a wire that does not fit there; keys:
/// those of the file that give the far end and the direction.
void stretch(DeclaredWire& wire, const base::TomlTable& table, const std::string& to_key,
             const std::string& bulge_key);
/// The wire at rest where its mounts are. Throws InputError when it finds no rest. shape: where it rests in
/// its own frame, chord along x and bulge to y, (3, vertices) [m]; none: it is looked for.
[[nodiscard]] coupling::MotionWire at_rest(DeclaredWire wire, const Eigen::Matrix3Xd* shape = nullptr);

/// A body, which moves by its centre of mass, and where that is in the frame that has the body's name [m].
struct DeclaredBody {
  coupling::MotionBody body;
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
};
/// A body but for the frame on which its place counts.
[[nodiscard]] DeclaredBody read_body(const base::TomlTable& table);

/// A shape with friction and foundation, in the frame on which it is, on no body and no wire yet.
[[nodiscard]] coupling::MotionContact read_contact_shape(const base::TomlTable& table,
                                                         const std::filesystem::path& folder,
                                                         std::string& meshes);
/// Indices of the wires that a shape may touch: those that it names, or all.
[[nodiscard]] std::vector<int> wires_met(const base::TomlTable& table, const Names& wires, std::size_t count);

/// Friction and foundation under the keys of a table.
[[nodiscard]] coupling::WirePair read_pair_law(const base::TomlTable& table);
/// Two wires that may touch each other.
[[nodiscard]] coupling::WirePair read_wire_pair(const base::TomlTable& table, const Names& wires,
                                                const std::vector<DeclaredWire>& declared);

/// Pose of an item in its frame: `position_mm`, and `rotation_deg` (a rotation vector) or `rpy_deg` (about
/// fixed axes).
[[nodiscard]] multibody::Pose read_pose_in_frame(const base::TomlTable& table);

}  // namespace snare::scenario
