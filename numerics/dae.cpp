#include "numerics/dae.hpp"

#include "base/errors.hpp"
#include "base/index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace snare::numerics {

int DaeLayout::add(DaeBlock block) {
  assert(block.count >= 0 && block.absolute_tolerance > 0.0);
  block.first = size_;
  size_ += block.count;
  blocks_.push_back(std::move(block));
  return blocks_.back().first;
}

std::string DaeLayout::name_of(int unknown) const {
  for (const DaeBlock& b : blocks_) {
    if (unknown < b.first || unknown >= b.first + b.count) continue;
    const int k = unknown - b.first;
    const auto each = std::max<int>(1, static_cast<int>(b.components.size()));
    std::string name = b.name;
    if (b.count > each) name += fmt::format(", no. {}", k / each);
    if (!b.components.empty()) name += ", " + b.components[static_cast<std::size_t>(k % each)];
    return name;
  }
  return fmt::format("unknown {}", unknown);
}

DaeSystem::DaeSystem(std::vector<DaePart*> parts) : parts_(std::move(parts)) {
  for (DaePart* part : parts_) {
    part->declare(layout_);
    event_count_ += part->event_count();
  }
}

void DaeSystem::leave_out_held(std::vector<std::pair<int, int>>& entries) {
  if (held_.empty()) return;
  std::vector<bool> is_held(base::at(size()), false);
  for (const int u : held_) is_held[base::at(u)] = true;
  const auto holds = [&](const std::pair<int, int>& e) {
    return is_held[base::at(e.first)] || is_held[base::at(e.second)];
  };
  std::erase_if(entries, holds);
  std::erase_if(rates_, holds);
  for (const int u : held_) entries.emplace_back(u, u);
}

void DaeSystem::make_pattern_anew() {
  std::vector<std::pair<int, int>> entries;
  rates_.clear();
  for (const DaePart* part : parts_) {
    part->sparsity(entries);
    part->rates(rates_);
  }
  leave_out_held(entries);
  matrix_ = make_pattern(size(), entries);
  for (DaePart* part : parts_) part->attach_pattern(matrix_);
  held_slots_.clear();
  for (const int u : held_) held_slots_.push_back(base::at(matrix_.slot(u, u)));
  ++pattern_version_;
  stale_pattern_ = false;
}

void DaeSystem::hold(std::vector<int> unknowns) {
  held_ = std::move(unknowns);
  stale_pattern_ = true;
}

void DaeSystem::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  rows.setZero();
  for (DaePart* part : parts_) part->residual(at, rows);
  for (const int u : held_) rows[u] = 0.0;
}

const SparseMatrix& DaeSystem::jacobian(const DaePoint& at, double c) {
  for (DaePart* part : parts_) stale_pattern_ = part->outgrows_pattern(at) || stale_pattern_;
  if (stale_pattern_) make_pattern_anew();
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for (DaePart* part : parts_) part->jacobian(at, c, matrix_.value);
  for (const std::size_t s : held_slots_) matrix_.value[s] = 1.0;
  return matrix_;
}

void DaeSystem::events(const DaePoint& at, std::span<double> values) {
  std::size_t first = 0;
  for (DaePart* part : parts_) {
    const auto count = static_cast<std::size_t>(part->event_count());
    part->events(at, values.subspan(first, count));
    first += count;
  }
}

IterationStart DaeSystem::iteration_start(const VectorView& from, const VectorView& to) {
  IterationStart first;
  for (DaePart* part : parts_) {
    const IterationStart own = part->iteration_start(from, to);
    first.share = std::min(first.share, own.share);
    first.out_of_reach = first.out_of_reach || own.out_of_reach;
  }
  return first;
}

void DaeSystem::accept(const DaePoint& at) {
  for (DaePart* part : parts_) part->accept(at);
}

double take(std::span<const double>& memory) {
  if (memory.empty())
    throw base::InputError({"", 0, "state", "", "must be that of the same motion: it is too short"});
  const double first = memory.front();
  memory = memory.subspan(1);
  return first;
}

std::vector<double> DaeSystem::memory() const {
  std::vector<double> memory;
  for (const DaePart* part : parts_) part->save_state(memory);
  return memory;
}

void DaeSystem::restore_state(const VectorView& y, std::span<const double> memory) {
  for (DaePart* part : parts_) part->restore_state(y, memory);
  if (!memory.empty())
    throw base::InputError({"", 0, "state", "", "must be that of the same motion: it is too long"});
  stale_pattern_ = true;
}

}  // namespace snare::numerics
