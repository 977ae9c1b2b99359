#include "app/arm_command.hpp"
#include "app/commands.hpp"
#include "app/export_command.hpp"
#include "app/interruption.hpp"
#include "app/new_command.hpp"
#include "app/result_folder.hpp"
#include "app/standard_streams.hpp"
#include "base/errors.hpp"
#include "base/inputs.hpp"
#include "base/one_line.hpp"
#include "base/parallel.hpp"
#include "base/toml_reader.hpp"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using snare::app::CommonOptions;
using snare::app::Console;
using snare::app::ExitStatus;

void add_overrides(CLI::App& verb, CommonOptions& options) {
  verb.add_option("--set", options.overrides, "override a key of the file: key=value (repeatable)")
      ->expected(1)
      ->take_all();
}

void add_common(CLI::App& verb, CommonOptions& options, const std::string& default_out) {
  options.out = default_out;
  verb.add_option("--out", options.out, "folder for the results")->capture_default_str();
  verb.add_option("--threads", options.threads, "number of threads; 0: one a processor")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  add_overrides(verb, options);
  verb.add_flag("--quiet", options.quiet, "no messages but errors");
  verb.add_flag("--json", options.json, "the result on standard output");
}

/// A verb that takes one file and the common options.
struct Verb {
  const char* name;
  const char* what;
  const char* argument;  ///< of the file on the command line; null: the verb takes none
  const char* meaning;   ///< of the file
  bool needed;           ///< the file may not be left out
  const char* example;
  ExitStatus (*run)(const std::filesystem::path& file, const CommonOptions& options, Console& console);
  const char* schema;  ///< of its result
};

const Verb verbs[] = {
    {"reproduce", "the published static wire tests with the computed curves, or all figures of a paper",
     "WHAT", "experiment file, or a paper: abiko, na, honda or all; the published tests when left out", false,
     "snare reproduce abiko --out out/abiko", snare::app::run_reproduce_word, "snare-reproduce/1"},
    {"push", "predict the force-displacement curves of the declared model", "EXPERIMENT.toml",
     "experiment file", true,
     "snare push data/experiments/published_static.toml --out out/push --set pusher.friction=0.2",
     snare::app::run_push, "snare-push/1"},
    {"fit", "calibrate the declared model's free numbers", "FILE.toml", "experiment file, or records in time",
     true, "snare fit data/experiments/published_static.toml --out out/fit", snare::app::run_fit,
     "snare-fit/1"},
    {"trace", "find the effect that the declared model lacks", "FILE.toml",
     "experiment file, or records in time", true,
     "snare trace data/experiments/published_static.toml --out out/trace", snare::app::run_trace,
     "snare-trace/1"},
    {"distil", "reduced spring laws and stiffness tables with their error bounds", "WIRE.toml", "wire file",
     true, "snare distil data/wires/traced_published.toml --out out/distil", snare::app::run_distil,
     "snare-law/1"},
    {"compare", "the same case with every wire model: accuracy and cost side by side", "SCENARIO.toml",
     "experiment, wire or scenario file", true,
     "snare compare data/experiments/published_static.toml --out out/compare", snare::app::run_compare,
     "snare-comparison/1"},
    {"simulate", "a dynamic scenario: wires, bodies, arms and snares in one system of equations",
     "SCENARIO.toml", "scenario file", true,
     "snare simulate data/scenarios/air_table.toml --out out/air_table", snare::app::run_simulate,
     "snare-summary/1"},
    {"ringdown", "damping of a wire from its free vibration", "RINGDOWN.toml", "ring-down file", true,
     "snare ringdown data/experiments/ringdown.toml --out out/ringdown", snare::app::run_ringdown,
     "snare-ringdown-result/1"},
    {"sweep", "many cases of a file at once; goes on where it was killed", "SWEEP.toml", "sweep file", true,
     "snare sweep data/sweeps/pin_offsets.toml --out out/sweep", snare::app::run_sweep,
     "snare-sweep-summary/1"},
    {"benchmark", "wire models, and anybody's history, scored on frozen cases with archived histories",
     "BENCHMARK.toml", "benchmark file; the shipped ring when left out", false,
     "snare benchmark --case impact_middle --against theirs.csv", snare::app::run_benchmark,
     "snare-benchmark-result/1"},
    {"validate", "every validation row: reference, its kind, value, error, limit, verdict", nullptr, nullptr,
     false, "snare validate --out out/validate",
     [](const std::filesystem::path&, const CommonOptions& options, Console& console) {
       return snare::app::run_validate(options, console);
     },
     "snare-validation/1"},
};

/// Runs one verb, whose result has a schema; what it throws becomes a message and an exit status.
template <typename Run>
ExitStatus guarded(const CommonOptions& options, const char* schema, const Run& run) {
  Console console(options.quiet);
  const snare::app::KeepWhenInterrupted word({}, options.json ? schema : "");
  if (options.threads > 0) snare::base::set_thread_count(options.threads);
  try {
    return run(console);
  } catch (const snare::base::InputError& error) {
    console.complain(error.what());
    return ExitStatus::wrong_input;
  } catch (const std::bad_alloc&) {
    console.complain("out of memory");
    return ExitStatus::failure;
  } catch (const std::length_error&) {
    console.complain("out of memory: a list of more entries than there can be");
    return ExitStatus::failure;
  } catch (const std::exception& error) {
    console.complain(error.what());
    return ExitStatus::failure;
  }
}

/// Words of the command line that are none of ours, with the nearest one: the library says only that they
/// were not expected.
void check_words(const CLI::App& app, int argc, char** argv) {
  const CLI::App* verb = &app;
  const auto refuse = [&verb, &app](const char* kind, const std::string& word,
                                    const std::vector<std::string>& known) {
    const std::string nearest = snare::base::nearest_word(word, known);
    std::string all;
    for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
    throw snare::base::InputError(
        {"", 0, verb == &app ? "snare" : "snare " + verb->get_name(), word,
         std::string("unknown ") + kind +
             (nearest.empty() ? "; there are: " + all : "; did you mean " + nearest + "?")});
  };
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word.starts_with("--") && word.size() > 2) {
      const std::string name = word.substr(0, word.find('='));
      const CLI::Option* option = verb->get_option_no_throw(name);
      if (option == nullptr) {
        std::vector<std::string> known;
        for (const CLI::Option* one : verb->get_options()) {
          for (const std::string& long_name : one->get_lnames()) known.push_back("--" + long_name);
        }
        refuse("option", name, known);
      }
      if (word == name && option->get_expected_min() > 0) ++k;  // its value
    } else if (!word.starts_with("-") && verb->get_require_subcommand_min() > 0) {
      const CLI::App* found = nullptr;
      std::vector<std::string> known;
      for (const CLI::App* one : verb->get_subcommands(nullptr)) {
        known.push_back(one->get_name());
        if (one->get_name() == word) found = one;
      }
      if (found == nullptr) refuse("verb", word, known);
      verb = found;
    }
  }
}

CLI::App* add_arm(CLI::App& app, std::filesystem::path& file, std::string& pose, CommonOptions& options) {
  CLI::App* arm = app.add_subcommand("arm", "robot arms");
  arm->require_subcommand(1);
  CLI::App* show = arm->add_subcommand("show", "chain, masses, reach and natural frequencies of an arm");
  show->add_option("FILE", file, "arm file")->required();
  show->add_option("--pose", pose, "a pose of the file, or angles in degrees: 0,30,-40");
  add_overrides(*show, options);
  show->add_flag("--json", options.json, "as JSON");
  show->footer("Example: snare arm show data/arms/jemrms_like.toml --pose bent");
  return show;
}

void add_new(CLI::App& app, std::string& what, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand("new", "a commented starter set of files that run");
  verb->add_option("WHAT", what, "capture, experiment or wire")->required();
  verb->add_option("--out", options.out, "folder for the files")->required();
  verb->add_flag("--quiet", options.quiet, "no messages but errors");
  verb->footer("Example: snare new capture --out my/");
}

void add_export(CLI::App& app, snare::app::ExportOptions& asked, CommonOptions& options) {
  CLI::App* verb = app.add_subcommand("export", "a law on a body of a model of MuJoCo");
  verb->add_option("LAW.json", asked.law, "law.json of snare distil")->required();
  verb->add_option("--mujoco", asked.mujoco, "model that takes the law (MJCF)")->required();
  verb->add_option("--body", asked.body, "body of the model that meets the wire")->required();
  verb->add_option("--position-mm", asked.position_mm,
                   "position along the span; the law's nearest to mid-span when left out");
  verb->add_option("--slack-mm", asked.slack_mm, "slack of the wire; that of the law when left out");
  verb->add_option("--axis", asked.axis,
                   "direction of the push in the body's frame: 0,1,0; that of its slide joint when left out");
  verb->add_option("--point-mm", asked.point_mm,
                   "point that meets the wire, in the body's frame: 50,100,0; its origin when left out");
  verb->add_option("--first-touch-mm", asked.first_touch_mm,
                   "travel of the body from the model's pose to first touch")
      ->capture_default_str();
  verb->add_option("--case", asked.number, "case of the law")->capture_default_str();
  options.out = "out/export";
  verb->add_option("--out", options.out, "folder for the results")->capture_default_str();
  verb->add_flag("--quiet", options.quiet, "no messages but errors");
  verb->footer(
      "Example: snare export out/distil/law.json --mujoco examples/air_table.xml --body target --point-mm "
      "50,100,0");
}

/// A verb of the list with its options and its file on the command line.
struct Parsed {
  CLI::App* command = nullptr;
  CommonOptions options;
  std::filesystem::path file;
};

void add_verb(CLI::App& app, const Verb& verb, Parsed& parsed) {
  parsed.command = app.add_subcommand(verb.name, verb.what);
  if (verb.argument != nullptr)
    parsed.command->add_option(verb.argument, parsed.file, verb.meaning)->required(verb.needed);
  CommonOptions& options = parsed.options;
  add_common(*parsed.command, options, std::string("out/") + verb.name);
  if (verb.run == snare::app::run_sweep)
    parsed.command->add_option("--case", options.only_case, "run this case alone, as its verb would")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000'000'000}, "CASE from 1 to 1e12"));
  if (verb.run == snare::app::run_benchmark) {
    parsed.command->add_option("--case", options.only_named, "this case alone, by its name");
    parsed.command->add_option("--against", options.against,
                               "CSV file of a history that is scored on the case, too");
    parsed.command->add_flag("--archive", options.archive,
                             "make the archived histories again, in the folder of the file");
  }
  parsed.command->footer(std::string("Example: ") + verb.example);
}

/// Everything that the command line may ask for.
struct Asked {
  std::vector<Parsed> parsed = std::vector<Parsed>(std::size(verbs));  // CLI11 keeps pointers into it
  CommonOptions arm_options, new_options, export_options;
  std::filesystem::path arm_file;
  std::string arm_pose, new_what;
  CLI::App* arm_show = nullptr;
  snare::app::ExportOptions exported;
};

void add_everything(CLI::App& app, Asked& asked) {
  for (std::size_t k = 0; k < std::size(verbs); ++k) add_verb(app, verbs[k], asked.parsed[k]);
  asked.arm_show = add_arm(app, asked.arm_file, asked.arm_pose, asked.arm_options);
  add_new(app, asked.new_what, asked.new_options);
  add_export(app, asked.exported, asked.export_options);
}

/// Parses the command line; a status where that ends the program.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    check_words(app, argc, argv);
    app.parse(argc, argv);
  } catch (const snare::base::InputError& error) {
    snare::app::tell(snare::base::visible_lines(error.what()) + "\n");
    return static_cast<int>(ExitStatus::wrong_input);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, complaint;
    const int code = app.exit(error, out, complaint);
    snare::app::tell(snare::base::visible_lines(complaint.str()));
    snare::app::print(out.str());
    return code == 0 ? 0 : static_cast<int>(ExitStatus::wrong_input);
  }
  return std::nullopt;
}

/// Runs the verb that was asked for.
ExitStatus run_asked(const CLI::App& app, Asked& asked) {
  if (asked.arm_show->parsed())
    return guarded(asked.arm_options, "snare-arm-show/1", [&](Console& c) {
      return snare::app::run_arm_show(asked.arm_file, asked.arm_pose, asked.arm_options, c);
    });
  if (app.get_subcommand("new")->parsed()) {
    asked.new_options.command = "snare new " + snare::base::shell_word(asked.new_what);
    return guarded(asked.new_options, "",
                   [&](Console& c) { return snare::app::run_new(asked.new_what, asked.new_options, c); });
  }
  if (app.get_subcommand("export")->parsed()) {
    asked.export_options.command = "snare export " + snare::base::shell_word(asked.exported.law.string());
    return guarded(asked.export_options, "", [&](Console& c) {
      return snare::app::run_export(asked.exported, asked.export_options, c);
    });
  }
  for (std::size_t k = 0; k < std::size(verbs); ++k) {
    Parsed& p = asked.parsed[k];
    if (!p.command->parsed()) continue;
    p.options.command = std::string("snare ") + verbs[k].name +
                        (p.file.empty() ? "" : " " + snare::base::shell_word(p.file.string()));
    return guarded(p.options, verbs[k].schema,
                   [&](Console& c) { return verbs[k].run(p.file, p.options, c); });
  }
  return ExitStatus::failure;
}

int run(int argc, char** argv) {
  CLI::App app{"snare: the mechanics of loose wires under a pin"};
  app.require_subcommand(1);
  app.set_version_flag("--version", "snare " + snare::app::version());
  Asked asked;
  add_everything(app, asked);
  snare::app::catch_interrupts(snare::base::release_result_folders);
  if (const std::optional<int> status = parse(app, argc, argv)) return *status;
  return static_cast<int>(run_asked(app, asked));
}

}  // namespace

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // Blocks of a megabyte go back to the system when they are freed. glibc raises that limit with every block
  // by itself, and curves of many readings would leave holes.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
  snare::app::open_standard_streams();
  const snare::base::InputScope inputs(std::make_shared<snare::base::Inputs>());
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    snare::app::tell(snare::base::visible_lines(error.what()) + "\n");
    return static_cast<int>(ExitStatus::failure);
  }
}
