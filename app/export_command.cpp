#include "app/export_command.hpp"

#include "app/interruption.hpp"
#include "app/result_folder.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/units.hpp"
#include "reduction/mujoco_model.hpp"
#include "scenario/distilled_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

namespace snare::app {

namespace {

using base::InputError;
using base::mm;

constexpr double same_place = 1e-6;  // positions that differ by less are one [m]

/// Three numbers separated by commas or spaces.
std::optional<Eigen::Vector3d> three_numbers(const char* option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  const char* at = text.data();
  const char* const end = at + text.size();
  bool sound = true;
  for (int k = 0; k < 3 && sound; ++k) {
    while (at < end && (*at == ' ' || *at == ',')) ++at;
    const auto [stopped, error] = std::from_chars(at, end, values[k]);
    sound = error == std::errc() && std::isfinite(values[k]);
    at = stopped;
  }
  if (!sound || at != end) throw InputError({"", 0, option, text, "must be three numbers: 0,1,0"});
  return values;
}

reduction::MujocoMeeting meeting_of(const ExportOptions& asked) {
  reduction::MujocoMeeting meeting{
      asked.body, three_numbers("--axis", asked.axis), {}, asked.first_touch_mm * mm};
  if (meeting.axis && !(meeting.axis->norm() > 1e-9))
    throw InputError({"", 0, "--axis", asked.axis, "must not be all zero"});
  meeting.point = mm * three_numbers("--point-mm", asked.point_mm).value_or(Eigen::Vector3d::Zero());
  return meeting;
}

/// Position of the law [m].
double position_of(const ExportOptions& asked, const scenario::DistilledLaw& law, double slack,
                   Console& console) {
  if (asked.position_mm) {
    const double position = *asked.position_mm * mm;
    if (!law.in_range(0.0, position, slack))
      throw InputError(
          {"", 0, "--position-mm", fmt::format("{:g}", *asked.position_mm),
           fmt::format("must be {:g} to {:g}, the positions of the law{}", law.position[0] / mm,
                       law.position[1] / mm, law.loading->mirrored() ? ", or their mirror image" : "")});
    return position;
  }
  if (law.losses.empty())
    throw InputError({"", 0, "--position-mm", "", "must be given: the law has no law positions"});
  const double middle = 0.5 * law.wire.span;
  const auto nearest = std::ranges::min_element(law.losses, {}, [middle](const scenario::DistilledLoss& one) {
    return std::abs(one.position - middle);
  });
  if (law.losses.size() > 1) {
    std::string all;
    for (const scenario::DistilledLoss& one : law.losses)
      all += fmt::format("{}{:g}", all.empty() ? "" : ", ", one.position / mm);
    console.say(fmt::format("position {:g} mm, the nearest to mid-span of {}; --position-mm chooses another",
                            nearest->position / mm, all));
  }
  return nearest->position;
}

reduction::MujocoLaw law_of(const scenario::DistilledLaw& law, double position, double slack) {
  scenario::DistilledLoss loss;
  std::optional<double> linear;
  const bool nominal = std::abs(slack - law.nominal_slack) < same_place;
  for (const scenario::DistilledLoss& one : law.losses) {
    if (nominal && std::abs(one.position - position) < same_place) loss = one;
  }
  for (const scenario::SimpleLaw& one : law.simple) {
    if (nominal && one.name == "linear" && std::abs(one.position - position) < same_place)
      linear = one.values.front();
  }
  return reduction::mujoco_law(position, law.loading->curve(position, slack), linear, loss);
}

}  // namespace

ExitStatus run_export(const ExportOptions& asked, const CommonOptions& options, Console& console) {
  const std::vector<scenario::DistilledLaw> laws = scenario::read_law_file(asked.law);
  if (asked.number < 1 || asked.number > static_cast<int>(laws.size()))
    throw InputError({"", 0, "--case", fmt::format("{}", asked.number),
                      fmt::format("must be 1 to {}, the cases of the law", laws.size())});
  const scenario::DistilledLaw& law = laws[static_cast<std::size_t>(asked.number - 1)];
  const double slack = asked.slack_mm ? *asked.slack_mm * mm : law.nominal_slack;
  if (!(slack >= law.slack[0] - same_place && slack <= law.slack[1] + same_place))
    throw InputError(
        {"", 0, "--slack-mm", fmt::format("{:g}", slack / mm),
         fmt::format("must be {:g} to {:g}, the slacks of the law", law.slack[0] / mm, law.slack[1] / mm)});
  if (!(asked.first_touch_mm >= 0.0 && std::isfinite(asked.first_touch_mm)))
    throw InputError({"", 0, "--first-touch-mm", fmt::format("{:g}", asked.first_touch_mm), "must be >= 0"});
  const double position = position_of(asked, law, slack, console);
  const reduction::MujocoLaw one = law_of(law, position, slack);
  const reduction::MujocoTarget target(asked.mujoco);
  const reduction::MujocoMeeting meeting = meeting_of(asked);

  std::vector<std::pair<const char*, std::string>> files;
  std::vector<std::string> notes;
  for (const reduction::MujocoForm form : reduction::mujoco_forms) {
    if (!reduction::has_form(one, form)) continue;
    reduction::MujocoModel model = target.with(one, form, meeting, options.out);
    if (form == reduction::MujocoForm::law) notes = model.notes;
    if (form == reduction::MujocoForm::loop && !model.fixed) {
      notes.push_back("the friction loop is left out: it needs a body with one slide joint");
      continue;
    }
    files.emplace_back(reduction::file_of(form), std::move(model.text));
    console.say(fmt::format("{}: {}; readers: {}", reduction::file_of(form),
                            reduction::mujoco_words(one, form), reduction::readers_of(form)));
  }
  const ResultFolder folder(options, {"law_mujoco.xml", "law_mujoco_linear.xml", "law_mujoco_loop.xml"});
  begin_writing();
  for (const auto& [name, text] : files) base::write_text(options.out / name, text);
  for (const std::string& note : notes) console.say(note);
  console.say(fmt::format(
      "stable at MuJoCo's default step of 2 ms on {:.2g} kg and more, good to 0.1 % on {:.2g} kg and more; "
      "a lighter body "
      "needs a smaller step",
      0.04 * reduction::sufficient_mass(one), reduction::sufficient_mass(one)));
  console.say(fmt::format("wrote {} files to {}", files.size(), options.out.string()));
  return ExitStatus::done;
}

}  // namespace snare::app
