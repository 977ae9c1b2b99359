#include "app/arm_command.hpp"
#include "app/commands.hpp"
#include "numerics/errors.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

namespace {

using snare::app::CommonOptions;
using snare::app::ExitStatus;

void add_common(CLI::App& verb, CommonOptions& options, const std::string& default_out) {
  options.out = default_out;
  verb.add_option("--out", options.out, "folder for the results")->capture_default_str();
  verb.add_option("--threads", options.threads, "number of threads; 0: one a processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  verb.add_option("--set", options.overrides, "override a key of the file: key=value (repeatable)")->expected(1)->take_all();
  verb.add_flag("--quiet", options.quiet, "no messages but errors");
  verb.add_flag("--json", options.json, "the result on standard output");
}

int run(int argc, char** argv) {
  CLI::App app{"snare: the mechanics of loose wires under a pin"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "snare " + snare::app::version());

  CommonOptions push_options;
  std::filesystem::path push_file;
  CLI::App* push = app.add_subcommand("push", "predict the force-displacement curves of the declared model");
  push->add_option("EXPERIMENT.toml", push_file, "experiment file")->required();
  add_common(*push, push_options, "out/push");
  push->footer("Example: snare push data/experiments/published_static.toml --out out/push --set pusher.friction=0.2");

  CommonOptions fit_options;
  std::filesystem::path fit_file;
  CLI::App* fit = app.add_subcommand("fit", "calibrate the declared model's free numbers");
  fit->add_option("EXPERIMENT.toml", fit_file, "experiment file")->required();
  add_common(*fit, fit_options, "out/fit");
  fit->footer("Example: snare fit data/experiments/published_static.toml --out out/fit");

  CommonOptions trace_options;
  std::filesystem::path trace_file;
  CLI::App* trace = app.add_subcommand("trace", "find the effect that the declared model lacks");
  trace->add_option("EXPERIMENT.toml", trace_file, "experiment file")->required();
  add_common(*trace, trace_options, "out/trace");
  trace->footer("Example: snare trace data/experiments/published_static.toml --out out/trace");

  CommonOptions reproduce_options;
  std::filesystem::path reproduce_file;
  CLI::App* reproduce =
      app.add_subcommand("reproduce", "the published static wire tests beside the computed curves");
  reproduce->add_option("EXPERIMENT.toml", reproduce_file, "experiment file; the published tests when left out");
  add_common(*reproduce, reproduce_options, "out/reproduce");
  reproduce->footer("Example: snare reproduce --out out/reproduce --set series[s40].law.to_mm=5");

  CommonOptions validate_options;
  CLI::App* validate = app.add_subcommand("validate", "every validation row: reference, value, error, limit, verdict");
  add_common(*validate, validate_options, "out/validate");
  validate->footer("Example: snare validate --out out/validate");

  CommonOptions arm_options;
  std::filesystem::path arm_file;
  std::string arm_pose;
  CLI::App* arm = app.add_subcommand("arm", "robot arms");
  arm->require_subcommand(1);
  CLI::App* arm_show = arm->add_subcommand("show", "chain, masses, reach and natural frequencies of an arm");
  arm_show->add_option("FILE", arm_file, "arm file")->required();
  arm_show->add_option("--pose", arm_pose, "a pose of the file, or angles in degrees: 0,30,-40");
  arm_show->add_option("--set", arm_options.overrides, "override a key of the file: key=value (repeatable)")->expected(1)->take_all();
  arm_show->add_flag("--json", arm_options.json, "as JSON");
  arm_show->footer("Example: snare arm show data/arms/jemrms_like.toml --pose bent");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ExitStatus::wrong_input);
  }

  snare::app::catch_interrupts();
  const auto call = [](const CommonOptions& options, const auto& verb) {
    snare::app::Console console(options.quiet);
    try {
      return verb(console);
    } catch (const snare::numerics::InputError& error) {
      console.complain(error.what());
      return ExitStatus::wrong_input;
    } catch (const std::bad_alloc&) {
      console.complain("out of memory");
      return ExitStatus::failure;
    } catch (const std::exception& error) {
      console.complain(error.what());
      return ExitStatus::failure;
    }
  };
  ExitStatus status = ExitStatus::failure;
  if (push->parsed()) {
    status = call(push_options, [&](snare::app::Console& c) { return snare::app::run_push(push_file, push_options, c); });
  } else if (reproduce->parsed()) {
    status = call(reproduce_options, [&](snare::app::Console& c) {
      return snare::app::run_reproduce(reproduce_file, reproduce_options, c);
    });
  } else if (fit->parsed()) {
    status = call(fit_options, [&](snare::app::Console& c) { return snare::app::run_fit(fit_file, fit_options, c); });
  } else if (trace->parsed()) {
    status = call(trace_options, [&](snare::app::Console& c) { return snare::app::run_trace(trace_file, trace_options, c); });
  } else if (arm_show->parsed()) {
    status = call(arm_options, [&](snare::app::Console& c) { return snare::app::run_arm_show(arm_file, arm_pose, arm_options, c); });
  } else if (validate->parsed()) {
    status = call(validate_options, [&](snare::app::Console& c) { return snare::app::run_validate(validate_options, c); });
  }
  return static_cast<int>(status);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitStatus::failure);
  }
}
