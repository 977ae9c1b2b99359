#pragma once

#include "app/console.hpp"
#include "results/version.hpp"

#include <filesystem>

namespace snare::app {

using namespace results;

/// The verbs. Each reads its input, computes, writes its files into options.out, and returns the exit status.
/// Wrong input is thrown as base::InputError before anything is written.

/// Force-displacement curves of the declared model: curves.csv.
[[nodiscard]] ExitStatus run_push(const std::filesystem::path& experiment, const CommonOptions& options,
                                  Console& console);

/// The static wire tests of the literature beside the computed curves: curves.csv, reproduce.json,
/// report.html, traced.toml. `experiment` empty: the shipped file of the published tests.
[[nodiscard]] ExitStatus run_reproduce(const std::filesystem::path& experiment, const CommonOptions& options,
                                       Console& console);

/// `snare reproduce WORD`: "abiko", "na", "honda" or "all" makes the figures and tables of these papers: a
/// page a paper, figures.json. Anything else is an experiment file.
[[nodiscard]] ExitStatus run_reproduce_word(const std::filesystem::path& what, const CommonOptions& options,
                                            Console& console);

/// Calibrates the declared model's free numbers: fit.json, curves.csv.
[[nodiscard]] ExitStatus run_fit(const std::filesystem::path& experiment, const CommonOptions& options,
                                 Console& console);

/// Finds what the declared model lacks: trace.json, curves.csv, report.html.
[[nodiscard]] ExitStatus run_trace(const std::filesystem::path& experiment, const CommonOptions& options,
                                   Console& console);

/// Spring laws and stiffness tables of one wire: law.json, table.csv, report.html, sources in other
/// languages.
[[nodiscard]] ExitStatus run_distil(const std::filesystem::path& wire, const CommonOptions& options,
                                    Console& console);

/// Every wire model on the same case: compare.json, report.html.
[[nodiscard]] ExitStatus run_compare(const std::filesystem::path& scenario, const CommonOptions& options,
                                     Console& console);

/// A dynamic scenario: history.csv, summary.json, report.html, ParaView files on request.
[[nodiscard]] ExitStatus run_simulate(const std::filesystem::path& scenario, const CommonOptions& options,
                                      Console& console);

/// Frequency and damping from free vibrations: ringdown.json, ringdown.csv, report.html.
[[nodiscard]] ExitStatus run_ringdown(const std::filesystem::path& ringdown, const CommonOptions& options,
                                      Console& console);

/// Many cases of one file: cases.csv, summary.json, report.html; continues where it was killed.
[[nodiscard]] ExitStatus run_sweep(const std::filesystem::path& sweep, const CommonOptions& options,
                                   Console& console);

/// Wire models scored on frozen cases with archived histories: benchmark.json, scores.csv, report.html.
[[nodiscard]] ExitStatus run_benchmark(const std::filesystem::path& benchmark, const CommonOptions& options,
                                       Console& console);

/// Every validation row: validation.json, report.html.
[[nodiscard]] ExitStatus run_validate(const CommonOptions& options, Console& console);

/// The shipped data, beside the sources or where they were installed.
[[nodiscard]] std::filesystem::path data_directory();

}  // namespace snare::app
