#include "papers/papers.hpp"

#include <string_view>

namespace snare::papers {

std::vector<const Paper*> all_papers() {
  return {&abiko(), &na(), &honda()};
}

std::vector<validation::Check> paper_checks(const std::filesystem::path& data) {
  std::vector<validation::Check> checks;
  for (const Paper* paper : all_papers()) {
    checks.push_back({std::string("figures and tables of ") + paper->short_title, [paper, data] {
                        Runs runs(data);
                        std::vector<validation::Row> rows;
                        for (const Figure& figure : paper->figures) {
                          if (figure.compute == nullptr || !std::string_view(figure.compared_in).empty())
                            continue;
                          const FigureResult result = made(*paper, figure, runs);
                          rows.insert(rows.end(), result.rows.begin(), result.rows.end());
                        }
                        return rows;
                      }});
  }
  return checks;
}

}  // namespace snare::papers
