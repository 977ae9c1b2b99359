// Traces what a model of a wire lacks: reads an experiment file with its CSV files, fits the two
// stiffnesses, and names the effect that explains what is left.
//
// push.toml beside this program stands for an experiment of one's own. Its readings were computed, not
// measured: the travel counts from 0.25 mm before the first touch, and noise of 0.2 N was added. The
// tracing has to find that out.
#include <snare/identification/effects/catalogue.hpp>
#include <snare/identification/tracing/trace.hpp>

#include <exception>
#include <iostream>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::cerr << "usage: example_trace_csv EXPERIMENT.toml\n";
    return 2;
  }
  namespace identification = snare::identification;
  const identification::Experiment experiment =
      identification::read_experiment(arguments[1], identification::parameters());
  const identification::Trace trace = identification::trace(experiment);
  if (!trace.report.usable()) {
    std::cerr << trace.report.message << '\n';
    return 3;
  }
  std::cout << "rms error of the fitted model: " << trace.base.rmse << " N\n";
  for (const std::string& effect : trace.selected) std::cout << "it lacks: " << effect << '\n';
  std::cout << "rms error with it: " << trace.final.rmse << " N\n";
  for (const identification::FittedNumber& number : trace.final.numbers) {
    std::cout << number.key << ": " << number.value << ' ' << number.unit << '\n';
  }
} catch (const std::exception& problem) {  // a wrong file: every mistake with its line
  std::cerr << problem.what() << '\n';
  return 2;
}
