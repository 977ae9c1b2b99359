#include "app/motion_json.hpp"

namespace snare::app {

using nlohmann::json;

json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void add_result(const coupling::MotionResult& r, json& object) {
  const numerics::IdaStatistics& n = r.statistics;
  object.update({{"finished", r.report.usable()},
                 {"message", r.report.usable() ? json() : json(r.report.message)},
                 {"time_s", r.report.time},
                 {"energy_J",
                  {{"kinetic", r.energy.kinetic},
                   {"strain", r.energy.strain},
                   {"potential", r.energy.potential},
                   {"dissipated", r.energy.dissipated},
                   {"impacts", r.energy.impacts},
                   {"work", r.energy.work},
                   {"integrator", r.energy.integrator}}},
                 {"momentum_error_Ns", vector_json(r.momentum_error)},
                 {"angular_momentum_error_Nms", vector_json(r.angular_momentum_error)},
                 {"largest_penetration_m", r.largest_penetration},
                 {"largest_gap_m", r.largest_gap},
                 {"largest_drift", r.largest_drift},
                 {"steps", n.steps},
                 {"residuals", n.residuals},
                 {"jacobians", n.jacobians},
                 {"factorizations", n.factorizations},
                 {"analyses", n.analyses},
                 {"restarts", n.restarts},
                 {"wall_s", r.wall_seconds},
                 {"real_time_factor", r.wall_seconds > 0.0 ? r.report.time / r.wall_seconds : 0.0}});
}

}  // namespace snare::app
