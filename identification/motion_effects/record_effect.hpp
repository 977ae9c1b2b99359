#pragma once

#include "identification/records/record_model.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// An effect that a declared scenario may lack, at one place of it. Every kind is one file,
/// identification/motion_effects/<name>.cpp, which says what it is, where in a scenario it may sit, which
/// numbers it has and how they enter: a key of the files, or a change of what a sensor tells.
struct RecordEffect {
  std::string name{};
  std::string place{};                  ///< "drive::screw", a wire, a sensor; empty: the whole
  std::string channel{};                ///< joint, body, bushing, ring, wire, contact, sensor, record
  std::string meaning{};                ///< what happens, for a test engineer
  std::vector<RecordNumber> numbers{};  ///< at null: RecordNumber::declared
  double plausible_lower = -1e300, plausible_upper = 1e300;  ///< of the first number
  bool one_sided = false;                                    ///< the first number can only grow from null
  std::string independent_check{};                           ///< a measurement that settles it by itself

  /// "joint_coulomb_friction (drive::screw)".
  [[nodiscard]] std::string label() const { return place.empty() ? name : name + " (" + place + ")"; }
};

/// What an effect of a joint needs to know of it.
struct JointPlace {
  std::string name;    ///< "drive::screw"
  std::string prefix;  ///< of its keys: "arms[drive].joint.screw."
  JointUse use;
};
/// Joints of arms, which have files; those of snares are not among them.
[[nodiscard]] std::vector<JointPlace> joint_places(const RecordModel& model);

/// A number that stands at `null` and is tried in steps of `scale`, both in the unit of its key. In a record
/// that declares it otherwise it differs from that by as much.
[[nodiscard]] RecordNumber number_at(const std::string& key, double null, double scale);

/// The effect of a declared number > 0 being another, for every element of a list of the scenario that
/// declares it: `LIST[NAME].KEY`, plausible between a fifth and five times what is declared. In a record that
/// declares it otherwise it is another by the same factor.
[[nodiscard]] std::vector<RecordEffect> other_number(const RecordModel& model, const std::string& list,
                                                     const std::string& key, const RecordEffect& what);
/// The same of a number of every wire, those of snares among them: `wires[NAME].KEY`,
/// `snares[NAME].wire.KEY`.
[[nodiscard]] std::vector<RecordEffect> other_wire_number(const RecordModel& model, const std::string& key,
                                                          const RecordEffect& what);
/// The same of a number of every joint's file.
[[nodiscard]] std::vector<RecordEffect> other_joint_number(const RecordModel& model, const std::string& key,
                                                           const RecordEffect& what);
/// The effect of a declared vector of three being another, tried in steps of `scale` (in the key's unit), for
/// every body that declares it: `bodies[NAME].KEY`.
[[nodiscard]] std::vector<RecordEffect> other_body_vector(const RecordModel& model, const std::string& key,
                                                          const RecordEffect& what, double scale);

/// Whether the file fits this key, or one that holds it.
[[nodiscard]] bool is_fitted(const RecordModel& model, const std::string& key);

/// Every fitted channel once, for effects of sensors: its sensor's column and the rms of its readings less
/// their mean.
struct ChannelPlace {
  std::string column;
  /// rms in the unit of the column; between two readings, of the record [s]
  double rms = 0.0, interval = 0.0, duration = 0.0;
};
[[nodiscard]] std::vector<ChannelPlace> channel_places(const RecordModel& model);

/// All effects that this scenario may lack.
[[nodiscard]] std::vector<RecordEffect> motion_effects(const RecordModel& model);
/// Names of the kinds, as the list has them.
[[nodiscard]] const std::vector<std::string>& motion_effect_names();

}  // namespace snare::identification
