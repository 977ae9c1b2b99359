#include "reduction/curve_store.hpp"

#include "base/archive.hpp"
#include "base/own_file.hpp"
#include "base/parallel.hpp"
#include "coupling/statics/push_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <system_error>

namespace snare::reduction {

namespace {

/// Everything that a curve depends on but its place, as text.
std::string identity(const WireCase& wire, const DistilSettings& settings,
                     const std::vector<double>& travel) {
  const coupling::PushProblem& t = wire.test;
  std::string text = fmt::format(
      "EI {} EA {} kappa {} GJ {} span {} mount {} {} radius {} mu {} machine {} {} turn {} mode {} plane {} "
      "g {} {} "
      "{} rho {} elements {} {}",
      t.wire.bending_stiffness(), t.wire.axial_stiffness(), t.wire.natural_curvature,
      t.wire.torsional_stiffness(), t.mount.span, static_cast<int>(t.mount.kind), t.mount.support_radius,
      t.pusher.radius, t.pusher.friction, t.pusher.compliance, static_cast<int>(t.pusher.direction),
      t.pusher.misalignment, t.bulge.mode, t.bulge.plane, t.gravity[0], t.gravity[1], t.gravity[2],
      t.wire.mass_per_length(), settings.elements, settings.extrapolate);
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) text += fmt::format(" {} {}", name, *value);
  };
  add("kt", t.mount.translational_stiffness);
  add("kr", t.mount.rotational_stiffness);
  for (const std::size_t k : {0, 1}) {
    text +=
        fmt::format(" {} {}", t.mount.own_translational_compliance[k], t.mount.own_rotational_compliance[k]);
  }
  add("slip", t.mount.slip_tension);
  if (t.mount.slip_tension)
    text += fmt::format(" {} {}", static_cast<int>(t.mount.slip), static_cast<int>(t.mount.slip_at));
  if (t.wire.strand_friction)
    text += fmt::format(" strands {} {} {}", t.wire.strand_friction->extra_stiffness,
                        t.wire.strand_friction->slip_curvature, t.wire.strand_friction->breadth);
  // The curvature at which metal yields depends on the diameter.
  if (t.wire.yielding)
    text += fmt::format(" yield {} {} {} {}", t.wire.yielding->yield_stress, t.wire.yielding->hardening_ratio,
                        t.wire.diameter, t.wire.youngs_modulus);
  for (const double factor : t.wire.bending_profile) text += fmt::format(" {}", factor);
  for (const double d : travel) text += fmt::format(" {}", d);
  return fmt::format("{:016x}", base::fingerprint(text));
}

void append(std::string& text, const std::vector<double>& values) {
  text += fmt::format(" {}", values.size());
  for (const double v : values) text += fmt::format(" {}", v);
}

/// One line of the journal: identity, place, curve, and the hash of all that.
std::string journal_line(const std::string& identity, const CurvePlace& place, const PushedCurve& curve) {
  std::string text = fmt::format("{} {} {} {} {} {}", identity, place.position, place.slack,
                                 curve.discretisation_error, curve.largest_strain, curve.dissipated);
  append(text, curve.loading);
  append(text, curve.unloading);
  return fmt::format("{} {:016x}\n", text, base::fingerprint(text));
}

/// Numbers with a space before each, up to the first that is none.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at < end;) {
    double value = 0.0;
    const auto [after, error] = std::from_chars(at + 1, end, value);
    if (error != std::errc()) break;
    numbers.push_back(value);
    at = after;
  }
  return numbers;
}

}  // namespace

CurveStore::CurveStore(WireCase wire, const DistilSettings& settings, std::vector<double> travel,
                       std::filesystem::path journal, JournalTrouble trouble)
    : wire_(std::move(wire)),
      settings_(settings),
      travel_(std::move(travel)),
      journal_(std::move(journal)),
      trouble_(std::move(trouble)),
      identity_(identity(wire_, settings_, travel_)) {
  if (!journal_.empty() && std::filesystem::exists(journal_)) read_journal();
}

double CurveStore::folded(double position) const noexcept {
  const double span = wire_.test.mount.span;
  return wire_.symmetric() && position > 0.5 * span ? span - position : position;
}

void CurveStore::read_journal() {
  const std::string text = base::read_own(journal_, std::size_t{1} << 30u);
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) break;  // torn
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    const std::size_t last = line.rfind(' ');
    if (last == std::string_view::npos ||
        line.substr(last + 1) != fmt::format("{:016x}", base::fingerprint(line.substr(0, last))))
      continue;
    if (line.substr(0, identity_.size()) != identity_) continue;
    // The place, what is said of the curve, then each branch after its length: see journal_line.
    const std::vector<double> n = numbers_in(line.substr(identity_.size(), last - identity_.size()));
    const std::size_t points = travel_.size();
    if (n.size() < points + 7 || n[5] != static_cast<double>(points)) continue;
    const auto unloading = n.begin() + static_cast<std::ptrdiff_t>(points) + 7;
    curves_.emplace(
        CurvePlace{n[0], n[1]},
        PushedCurve{{n.begin() + 6, unloading - 1}, {unloading, n.end()}, n[2], n[3], n[4], true, {}});
  }
}

void CurveStore::give_up_journal() {
  const std::string why = std::generic_category().message(errno);
  if (trouble_) trouble_(fmt::format("{}: cannot be written: {}", journal_.string(), why));
  journal_.clear();
}

base::FileHandle CurveStore::open_journal() {
  base::FileHandle file;
  if (journal_.empty()) return file;
  if (journal_.has_parent_path()) std::filesystem::create_directories(journal_.parent_path());
  file.reset(std::fopen(journal_.c_str(), "ab"));
  constexpr char line_feed = '\n';  // ends a torn line
  if (!file || std::fwrite(&line_feed, 1, 1, file.get()) != 1) {
    give_up_journal();
    file.reset();
  }
  return file;
}

PushedCurve CurveStore::solve(const CurvePlace& place) const {
  coupling::PushProblem test = wire_.test;
  test.contact_position = place.position;
  test.wire.length = test.mount.span + place.slack;
  test.travel = travel_;
  const bool returns = wire_.dissipates();
  if (returns) test.travel.insert(test.travel.end(), travel_.rbegin() + 1, travel_.rend());
  coupling::PushOptions options;
  options.elements = settings_.elements;
  coupling::ExtrapolatedCurve solution;
  if (settings_.extrapolate)
    solution = coupling::solve_push_extrapolated(test, options);
  else
    solution.curve = coupling::solve_push(test, options);

  PushedCurve curve;
  std::vector<double> force;
  bool stable = true;
  const std::vector<coupling::PushPoint>& points = solution.curve.points;
  // Points that the path passed between the asked ones have no travel here.
  for (std::size_t i = 0; i < points.size() && force.size() < test.travel.size(); ++i) {
    if (points[i].travel != test.travel[force.size()]) continue;
    if (points[i].unstable_modes > 0) {
      stable = false;
      break;
    }
    force.push_back(points[i].force);
    curve.largest_strain =
        std::max(curve.largest_strain, points[i].largest_tension / test.wire.axial_stiffness());
    curve.dissipated = points[i].dissipated;
    if (i < solution.discretisation_error.size())
      curve.discretisation_error = std::max(curve.discretisation_error, solution.discretisation_error[i]);
  }
  curve.complete = force.size() == test.travel.size();
  if (!curve.complete) {
    const std::string reason = !stable ? fmt::format("the wire becomes unstable at a travel of {:.4g} mm",
                                                     1e3 * test.travel[force.size()])
                                       : solution.curve.report.message;
    curve.stopped = fmt::format("at s = {:.4g} mm and a slack of {:.4g} mm: {}", 1e3 * place.position,
                                1e3 * place.slack, reason);
  }
  const std::size_t up = std::min(force.size(), travel_.size());
  curve.loading.assign(force.begin(), force.begin() + static_cast<std::ptrdiff_t>(up));
  if (returns && curve.complete) {
    curve.unloading.assign(force.rbegin(), force.rbegin() + static_cast<std::ptrdiff_t>(travel_.size()));
  }
  return curve;
}

numerics::SolveReport CurveStore::sample(const std::vector<CurvePlace>& places,
                                         const SamplingObserver& observer) {
  std::vector<CurvePlace> wanted;
  for (CurvePlace place : places) {
    place.position = folded(place.position);
    if (curves_.contains(place) && curves_.at(place).complete) continue;
    if (std::find(wanted.begin(), wanted.end(), place) == wanted.end()) wanted.push_back(place);
  }
  base::FileHandle journal = wanted.empty() ? base::FileHandle() : open_journal();
  std::vector<PushedCurve> results(wanted.size());
  std::atomic<bool> stop{false};
  std::size_t finished = 0;
  std::mutex finishing;  // journal, results and observer take one curve at a time
  base::parallel_for(wanted.size(), [&](std::size_t k) {
    if (stop) return;
    PushedCurve curve = solve(wanted[k]);
    const std::lock_guard lock(finishing);
    ++finished;
    if (journal && curve.complete) {
      const std::string line = journal_line(identity_, wanted[k], curve);
      if (std::fwrite(line.data(), 1, line.size(), journal.get()) != line.size() ||
          std::fflush(journal.get()) != 0) {
        give_up_journal();
        journal.reset();
      }
    }
    results[k] = std::move(curve);
    if (observer && !observer(finished, wanted.size())) stop = true;
  });
  if (journal && std::fclose(journal.release()) != 0) give_up_journal();
  numerics::SolveReport report;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (results[k].loading.empty() && results[k].stopped.empty()) continue;  // not begun
    ++solved_;
    if (!results[k].complete && report.usable()) {
      report.end(numerics::Termination::step_too_small, results[k].stopped);
    }
    curves_[wanted[k]] = std::move(results[k]);
  }
  if (stop && report.usable()) {
    report.end(numerics::Termination::interrupted, "interrupted");
  }
  return report;
}

}  // namespace snare::reduction
