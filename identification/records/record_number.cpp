#include "identification/records/record_number.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace snare::identification {

std::string exact_text(double value) {
  std::string text = fmt::format("{:.17g}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";  // TOML tells integers from numbers
  return text;
}

std::string unit_of_key(const std::string& key) {
  static constexpr std::pair<std::string_view, std::string_view> units[] = {{"_Nms2_rad2", "N m s^2/rad^2"},
                                                                            {"_Nms_rad", "N m s/rad"},
                                                                            {"_Nms_deg", "N m s/deg"},
                                                                            {"_Nm_rad", "N m/rad"},
                                                                            {"_Nm_deg", "N m/deg"},
                                                                            {"_kg_m2", "kg m^2"},
                                                                            {"_kg_m3", "kg/m^3"},
                                                                            {"_Ns_m", "N s/m"},
                                                                            {"_N_m2", "N/m^2"},
                                                                            {"_N_m", "N/m"},
                                                                            {"_Nm2", "N m^2"},
                                                                            {"_deg_s", "deg/s"},
                                                                            {"_rad_s", "rad/s"},
                                                                            {"_mm_s", "mm/s"},
                                                                            {"_m_s2", "m/s^2"},
                                                                            {"_m_s", "m/s"},
                                                                            {"_1_m", "1/m"},
                                                                            {"_1_s", "1/s"},
                                                                            {"_s_m", "s/m"},
                                                                            {"_GPa", "GPa"},
                                                                            {"_deg", "deg"},
                                                                            {"_Hz", "Hz"},
                                                                            {"_kg", "kg"},
                                                                            {"_mm", "mm"},
                                                                            {"_Nm", "N m"},
                                                                            {"_N", "N"},
                                                                            {"_m", "m"},
                                                                            {"_s", "s"}};
  std::string_view name = key;
  if (name.ends_with("]")) name = name.substr(0, name.find_last_of('['));
  for (const auto& [suffix, unit] : units)
    if (name.ends_with(suffix)) return std::string(unit);
  return "";
}

RecordNumber keyed_number(const std::string& key, double declared) {
  RecordNumber number;
  number.key = key;
  number.unit = unit_of_key(key);
  number.declared = declared;
  if (declared != 0.0) {
    number.scale = 0.01 * std::abs(declared);
    number.scale_follows = true;
  }
  number.overrides = [key](double value, const StandingNumbers&) {
    return std::vector<base::Override>{{key, exact_text(value)}};
  };
  return number;
}

}  // namespace snare::identification
