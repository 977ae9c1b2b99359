// Calls one verb of the C++ library for tests/promises/entries.py and writes how the call ended.
//
//   library_entry VERB FILE ENDING [--threads N] [--set KEY=VALUE]...
//
// ENDING is the JSON file to write: `status` (2 for InputError, 3 for SolverStopped, 1 for any other
// exception), `message`, `document`, and `not_finite`, the places of NaN and infinity in it. SIGINT stops the
// call through the library's watch.
#include "base/parallel.hpp"
#include "results/snare.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <string>

namespace {

std::atomic<bool> asked_to_stop{false};

void note_places(const nlohmann::json& value, const std::string& place, nlohmann::json& places) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) places.push_back(place);
  for (const auto& [key, one] : value.items()) {
    if (value.is_structured()) note_places(one, place + "." + key, places);
  }
}

}  // namespace

int main(int count, char** arguments) {
  using Verb = std::function<nlohmann::json(const std::string&, const snare::Overrides&,
                                            const snare::results::Watch&)>;
  const std::map<std::string, Verb> verbs{{"push", snare::push},
                                          {"fit", snare::fit},
                                          {"trace", snare::trace},
                                          {"distil", snare::distil},
                                          {"simulate", snare::simulate}};
  if (count < 4 || !verbs.contains(arguments[1])) return 64;
  snare::Overrides overrides;
  for (int k = 4; k + 1 < count; k += 2) {
    const std::string option = arguments[k], value = arguments[k + 1];
    if (option == "--threads") {
      snare::base::set_thread_count(std::stoi(value));
    } else {
      const std::size_t at = value.find('=');
      overrides.push_back({value.substr(0, at), value.substr(at + 1)});
    }
  }
  std::signal(SIGINT, [](int) { asked_to_stop = true; });
  nlohmann::json ending{
      {"status", 0}, {"message", ""}, {"document", nullptr}, {"not_finite", nlohmann::json::array()}};
  try {
    ending["document"] =
        verbs.at(arguments[1])(arguments[2], overrides, {{}, [] { return asked_to_stop.load(); }});
    note_places(ending["document"], "", ending["not_finite"]);
  } catch (const snare::base::InputError& error) {
    ending["status"] = 2;
    ending["message"] = error.what();
  } catch (const snare::SolverStopped& error) {
    ending["status"] = 3;
    ending["message"] = error.what();
  } catch (const std::exception& error) {
    ending["status"] = 1;
    ending["message"] = error.what();
  }
  std::ofstream(arguments[3]) << ending.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  return ending["status"].get<int>();
}
