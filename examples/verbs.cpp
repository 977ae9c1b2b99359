// The verbs of the command from C++: predicts a push, and asks what the declared wire lacks.
#include <snare/snare.hpp>

#include <iostream>

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: example_verbs EXPERIMENT.toml\n";
    return 2;
  }
  try {
    const nlohmann::json pushed = snare::push(arguments[1], {{"pusher.friction", "0.0"}});
    for (const auto& series : pushed.at("series"))
      std::cout << series.at("series") << ": up to " << series.at("largest_force_N") << " N\n";
    const nlohmann::json traced = snare::trace(arguments[1]);
    std::cout << traced.at("verdict").get<std::string>() << "\nselected: " << traced.at("selected") << '\n';
  } catch (const snare::base::InputError& error) {  // file, line, key, value, what is allowed
    std::cerr << error.what() << '\n';
    return 2;
  } catch (const snare::SolverStopped& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}
