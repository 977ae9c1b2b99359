#include "app/curves_csv.hpp"

#include "base/csv.hpp"
#include "base/units.hpp"

namespace snare::app {

void write_curves(const std::filesystem::path& file, const std::vector<identification::Series>& series,
                  const std::vector<identification::Prediction>& predictions, const std::vector<CurveColumn>& more) {
  using base::mm;
  std::vector<std::string> columns{"series",
                                   "displacement_mm",
                                   "force_N",
                                   "tension_left_N",
                                   "tension_right_N",
                                   "contact_arc_mm",
                                   "iterations",
                                   "converged",
                                   "discretisation_error_N",
                                   "transverse_force_N",
                                   "wrapped_mm",
                                   "in_contact",
                                   "slipping",
                                   "unstable_modes",
                                   "out_of_plane_modes",
                                   "axial_force_N",
                                   "energy_J",
                                   "dissipated_J",
                                   "imbalance_N"};
  for (const CurveColumn& column : more) columns.push_back(column.name);
  base::CsvWriter csv(file, columns);
  for (std::size_t k = 0; k < series.size(); ++k) {
    const identification::Prediction& prediction = predictions[k];
    const std::vector<double>& displacement = identification::measured_displacement(series[k]);
    const auto add_more = [&](std::vector<base::CsvCell>& row, std::size_t reading, bool asked) {
      for (const CurveColumn& column : more) {
        const bool has = asked && reading < column.values[k].size();
        row.push_back(has ? base::CsvCell(column.values[k][reading]) : base::CsvCell());
      }
    };
    for (std::size_t i = 0; i < prediction.before_touch; ++i) {
      std::vector<base::CsvCell> row(columns.size() - more.size());
      row[0] = series[k].name;
      row[1] = displacement[i] / mm;
      row[2] = 0.0;
      row[6] = 0LL;
      row[7] = 1LL;
      row[11] = 0LL;
      add_more(row, i, true);
      csv.row(row);
    }
    std::size_t reading = prediction.before_touch;
    const double offset = prediction.reading.displacement_offset;
    for (std::size_t i = 0; i < prediction.curve.curve.points.size(); ++i) {
      const coupling::PushPoint& p = prediction.curve.curve.points[i];
      const bool asked = reading < displacement.size() && p.travel == displacement[reading] - offset;
      std::vector<base::CsvCell> row{std::string_view(series[k].name),
                                     asked ? displacement[reading] / mm : (p.travel + offset) / mm,
                                     p.force,
                                     p.tension_left,
                                     p.tension_right,
                                     p.contact_coordinate / mm,
                                     static_cast<long long>(p.iterations),
                                     static_cast<long long>(p.converged),
                                     prediction.curve.discretisation_error[i],
                                     p.transverse_force,
                                     p.wrapped_length / mm,
                                     static_cast<long long>(p.in_contact),
                                     static_cast<long long>(p.slipping),
                                     static_cast<long long>(p.unstable_modes),
                                     static_cast<long long>(p.out_of_plane_modes),
                                     p.axial_force,
                                     p.energy,
                                     p.dissipated,
                                     p.imbalance};
      add_more(row, reading, asked);
      csv.row(row);
      if (asked) ++reading;
    }
  }
  csv.commit();
}

}  // namespace snare::app
