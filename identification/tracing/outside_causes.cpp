#include "identification/tracing/outside_causes.hpp"

#include <algorithm>

namespace snare::identification {

namespace {

constexpr double indistinct_chi2 = 6.0;  // difference below which the likelihood does not decide
constexpr double one_cause = 0.9;        // share of an excess that an unknown function must carry over
constexpr double rest_of_rival = 0.001;  // P below which an effect has left something in the direction of its rival

}  // namespace

std::vector<ChannelFunction> rivals_outside(const std::vector<ChannelFunction>& functions, Channel effect,
                                            double explained) {
  std::vector<ChannelFunction> rivals;
  for (const ChannelFunction& f : functions) {
    const bool elsewhere = f.channel != effect;
    if (elsewhere && f.carried_over > one_cause && f.chi2 < explained + indistinct_chi2) rivals.push_back(f);
  }
  return rivals;
}

bool simpler_outside(const std::vector<ChannelFunction>& rivals, const Model& model, const Data& data,
                     const Fit& current, std::size_t effects) {
  bool simpler = effects > 1;
  for (const ChannelColumns& c : channel_columns(model, data, current)) {
    const bool rival = std::any_of(rivals.begin(), rivals.end(), [&c](const ChannelFunction& f) {
      return f.channel == c.channel && f.argument == c.argument;
    });
    simpler = simpler || (rival && channel_p(c, current) < rest_of_rival);
  }
  return simpler;
}

}  // namespace snare::identification
