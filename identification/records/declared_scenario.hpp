#pragma once

#include "base/toml_tree.hpp"
#include "identification/records/record_set.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// What the files of a scenario and its arms say, for those who ask for a number by its key.
struct DeclaredScenario {
  base::TomlNode scenario;
  std::map<std::string, base::TomlNode> arms;  ///< files of the arms, by their names

  /// The number, in its key's unit, under a key such as `bodies[visitor].mass_kg`, `arms[a].angles_deg[2]` or
  /// `arms[a].joint.J1.coulomb_Nm` (of the joint's own table, else of `every_joint`); nothing where there is
  /// none.
  [[nodiscard]] std::optional<double> number(const std::string& key) const;
  /// The key of `every_joint` from which a joint's key takes its number where the joint has none of its own;
  /// else the key itself.
  [[nodiscard]] std::string key_of(const std::string& key) const;
  /// Likewise of a text.
  [[nodiscard]] std::optional<std::string> text(const std::string& key) const;
  /// Names of the elements of a list: "1", "2", ... where they have none.
  [[nodiscard]] std::vector<std::string> names(const std::string& list) const;

 private:
  [[nodiscard]] const base::TomlNode* find(const std::string& key) const;
};

/// Numbers of a declared scenario with some of them set otherwise.
struct StandingNumbers {
  const DeclaredScenario& declared;
  const std::vector<base::Override>& set;  ///< the last one of a key counts

  /// The number, in its key's unit, as it is set, else as it is declared. One of a joint that has none of its
  /// own is that of `every_joint`.
  [[nodiscard]] std::optional<double> number(const std::string& key) const;
};

/// Reads the files, with keys that are otherwise for all records and `more` of them. Throws InputError.
[[nodiscard]] DeclaredScenario declared_scenario(const RecordSet& set,
                                                 const std::vector<base::Override>& more = {});

}  // namespace snare::identification
