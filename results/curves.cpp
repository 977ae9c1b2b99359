#include "results/curves.hpp"

#include "base/csv.hpp"
#include "base/in_unit.hpp"
#include "base/units.hpp"
#include "results/in_mm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace snare::results {

namespace {

using base::CsvCell;
using base::mm;
using coupling::PushPoint;

/// A column that is a number of every point.
struct PointColumn {
  const char* name;
  std::variant<double PushPoint::*, int PushPoint::*, bool PushPoint::*> number;
  double unit = 1.0;
  CsvCell before_touch = {};

  [[nodiscard]] CsvCell cell(const PushPoint& p) const {
    if (const auto* real = std::get_if<double PushPoint::*>(&number))
      return unit == 1.0 ? p.**real : base::in_unit(p.**real, unit);
    if (const auto* count = std::get_if<int PushPoint::*>(&number)) return static_cast<long long>(p.**count);
    return static_cast<long long>(p.*std::get<bool PushPoint::*>(number));
  }
};

const PointColumn up_to_error[] = {
    {"force_N", &PushPoint::force, 1.0, 0.0},         {"tension_left_N", &PushPoint::tension_left},
    {"tension_right_N", &PushPoint::tension_right},   {"contact_arc_mm", &PushPoint::contact_coordinate, mm},
    {"iterations", &PushPoint::iterations, 1.0, 0LL}, {"converged", &PushPoint::converged, 1.0, 1LL}};
const PointColumn after_error[] = {{"transverse_force_N", &PushPoint::transverse_force},
                                   {"wrapped_mm", &PushPoint::wrapped_length, mm},
                                   {"in_contact", &PushPoint::in_contact, 1.0, 0LL},
                                   {"slipping", &PushPoint::slipping},
                                   {"unstable_modes", &PushPoint::unstable_modes},
                                   {"out_of_plane_modes", &PushPoint::out_of_plane_modes},
                                   {"axial_force_N", &PushPoint::axial_force},
                                   {"energy_J", &PushPoint::energy},
                                   {"dissipated_J", &PushPoint::dissipated},
                                   {"imbalance_N", &PushPoint::imbalance},
                                   {"reaction_along_left_N", &PushPoint::reaction_along_left},
                                   {"reaction_across_left_N", &PushPoint::reaction_across_left},
                                   {"reaction_z_left_N", &PushPoint::reaction_z_left},
                                   {"reaction_along_right_N", &PushPoint::reaction_along_right},
                                   {"reaction_across_right_N", &PushPoint::reaction_across_right},
                                   {"reaction_z_right_N", &PushPoint::reaction_z_right},
                                   {"largest_tension_N", &PushPoint::largest_tension}};

}  // namespace

void give_curves(TableSink& sink, const std::vector<identification::Series>& series,
                 const std::vector<identification::Prediction>& predictions,
                 const std::vector<CurveColumn>& more) {
  std::vector<std::string> names{"series", "displacement_mm"};
  for (const PointColumn& column : up_to_error) names.emplace_back(column.name);
  names.emplace_back("discretisation_error_N");
  for (const PointColumn& column : after_error) names.emplace_back(column.name);
  // What was read, and what the curve of force_N leaves of it.
  std::vector<std::vector<double>> measured;
  for (const identification::Series& s : series) measured.push_back(identification::measured_force(s));
  const bool any = std::ranges::any_of(measured, [](const std::vector<double>& one) { return !one.empty(); });
  if (any) names.emplace_back("measured_N");
  for (const CurveColumn& column : more) names.push_back(column.name);
  if (any) names.emplace_back("residual_N");
  sink.begin(std::move(names));
  for (std::size_t k = 0; k < series.size(); ++k) {
    const identification::Prediction& prediction = predictions[k];
    const std::vector<double>& displacement = identification::measured_displacement(series[k]);
    // A row of a point, or of a displacement before the touch.
    const auto write = [&](double at, const PushPoint* point, CsvCell error, std::size_t reading,
                           bool asked) {
      std::vector<CsvCell> row{std::string_view(series[k].name), in_mm(at)};
      const auto cell = [&](const PointColumn& c) {
        return point != nullptr ? c.cell(*point) : c.before_touch;
      };
      for (const PointColumn& column : up_to_error) row.push_back(cell(column));
      row.push_back(error);
      for (const PointColumn& column : after_error) row.push_back(cell(column));
      const bool read = any && asked && reading < measured[k].size();
      if (any) row.push_back(read ? CsvCell(measured[k][reading]) : CsvCell());
      for (const CurveColumn& column : more) {
        const bool has = asked && reading < column.values[k].size();
        row.push_back(has ? CsvCell(column.values[k][reading]) : CsvCell());
      }
      const bool computed = read && reading < prediction.force.size();
      if (any)
        row.push_back(computed ? CsvCell(measured[k][reading] - prediction.force[reading]) : CsvCell());
      sink.row(row);
    };
    for (std::size_t i = 0; i < prediction.before_touch; ++i) write(displacement[i], nullptr, {}, i, true);
    std::size_t reading = prediction.before_touch;
    const double offset = prediction.reading.displacement_offset;
    for (std::size_t i = 0; i < prediction.curve.curve.points.size(); ++i) {
      const PushPoint& p = prediction.curve.curve.points[i];
      // Branch switching adds points between the readings.
      const bool asked = reading < displacement.size() && p.travel == displacement[reading] - offset;
      const double error = prediction.curve.discretisation_error[i];
      write(asked ? displacement[reading] : p.travel + offset, &p,
            std::isfinite(error) ? CsvCell(error) : CsvCell(), reading, asked);
      if (asked) ++reading;
    }
  }
}

void write_curves(const std::filesystem::path& file, const std::vector<identification::Series>& series,
                  const std::vector<identification::Prediction>& predictions,
                  const std::vector<CurveColumn>& more) {
  CsvSink csv(file);
  give_curves(csv, series, predictions, more);
  csv.commit();
}

}  // namespace snare::results
