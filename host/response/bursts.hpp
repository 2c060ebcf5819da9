// Where a log holds a test signal, and how the signal is to be cut into blocks: stretches between two pauses in which
// it is zero, each periodic or not.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stiction::host {

struct Burst {
  std::size_t begin = 0, end = 0;  // samples, the latter behind the last one
  std::size_t period = 0;          // samples; 0: the signal does not repeat

  std::size_t size() const { return end - begin; }
};

// Stretches of `signal` that are not zero; zeros shorter than `shortest_pause` samples belong to them. A period is
// found where the signal repeats itself with a difference below 1 % rms, at least twice.
std::vector<Burst> find_bursts(std::span<const double> signal, std::size_t shortest_pause);

}  // namespace stiction::host
