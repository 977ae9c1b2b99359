#pragma once

#include "scenario/composition.hpp"

#include <functional>

namespace snare::scenario {

/// A drive from a time on, of a motor that then stands at an angle.
using DriveMaker = std::function<multibody::Drive(double time, double angle)>;

/// `mode` and what belongs to it, of a table of `[[drives]]` or of a phase: docs/scenario_file.md.
/// as_described: the drive of the arm's own file, whose gains stand where the table gives none. slides:
/// lengths in place of angles.
[[nodiscard]] DriveMaker read_drive(const base::TomlTable& table, const std::filesystem::path& folder,
                                    const multibody::Drive& as_described, bool slides, std::string& input);

/// `[[drives]]`: what the motors do from the start.
void read_drives(Composition& composition);

/// The joints that a table names under `joint` (one) or `joints` (of an arm or a snare, all).
[[nodiscard]] std::vector<MotorJoint> read_joints(const Composition& composition,
                                                  const base::TomlTable& table);

}  // namespace snare::scenario
