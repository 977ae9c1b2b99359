#include "app/report/motion_report.hpp"

namespace snare::app {

using coupling::MotionSample;
using nlohmann::json;

Curve time_curve(const std::string& name, int colour, const std::vector<MotionSample>& samples,
                 const std::function<double(const MotionSample&)>& value) {
  Curve curve{name, {}, {}, CurveStyle::line, colour};
  for (const MotionSample& s : samples) {
    curve.x.push_back(s.time);
    curve.y.push_back(value(s));
  }
  return curve;
}

void add_models(const json& models, ReportPage& page) {
  Table table{"",
              {{"Model", ColumnKind::code},
               {"Peak force [N]", ColumnKind::number},
               {"Impulse along y [N s]", ColumnKind::number},
               {"Velocity after, y [m/s]", ColumnKind::number},
               {"Spin after, z [rad/s]", ColumnKind::number},
               {"Touches", ColumnKind::number},
               {"Integrator's energy [J]", ColumnKind::number},
               {"Steps", ColumnKind::number},
               {"Real-time factor", ColumnKind::number}},
              {}};
  const auto number = [](const json& value) { return format_significant(value.get<double>()); };
  for (const json& m : models) {
    table.rows.push_back({m["model"].get<std::string>(), number(m["peak_force_N"]), number(m["impulse_Ns"][1]),
                          number(m["velocity_after_m_s"][1]), number(m["spin_after_rad_s"][2]),
                          std::to_string(m["touches"].get<int>()),
                          format_significant(m["energy_J"]["integrator"].get<double>(), 2),
                          std::to_string(m["steps"].get<long>()), number(m["real_time_factor"])});
    if (!m["finished"].get<bool>())
      page.callout(m["model"].get<std::string>() + ": " + m["message"].get<std::string>(), Tone::bad);
  }
  page.table(table);
}

void add_balance(const json& summary, ReportPage& page) {
  const auto number = [](const json& value) { return format_significant(value.get<double>(), 2); };
  if (!summary["finished"].get<bool>()) page.callout(summary["message"].get<std::string>(), Tone::bad);
  page.key_figures({{"Energy of the integrator", number(summary["energy_J"]["integrator"]) + " J",
                     "what the balance misses, all losses counted"},
                    {"Largest penetration", number(summary["largest_penetration_m"]) + " m", ""},
                    {"Steps", std::to_string(summary["steps"].get<long>()), ""},
                    {"Real-time factor", number(summary["real_time_factor"]), ""}});
}

}  // namespace snare::app
