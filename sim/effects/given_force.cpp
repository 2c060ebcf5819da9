#include "sim/effects/given_force.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

namespace stiction::sim {
namespace {

constexpr std::string_view given_prefix = "given force ";  // with blanks, as no folder and no key of a file has

// Runs of several threads make plants while one of them adds a law.
struct GivenForces {
  std::mutex mutex;
  std::uint64_t last = 0;
  std::map<std::string, std::shared_ptr<const GivenForce::Law>, std::less<>> laws;
};

GivenForces& given_forces() {
  static GivenForces all;
  return all;
}

}  // namespace

GivenForce::GivenForce(Law law) {
  auto& all = given_forces();
  const std::lock_guard lock(all.mutex);
  name_ = std::string(given_prefix) + std::to_string(++all.last);
  all.laws[name_] = std::make_shared<const Law>(std::move(law));
}

GivenForce::~GivenForce() {
  auto& all = given_forces();
  const std::lock_guard lock(all.mutex);
  all.laws.erase(name_);
}

std::shared_ptr<const GivenForce::Law> given_force(const machine::Effect& effect) {
  if (!effect.name.starts_with(given_prefix)) return nullptr;
  auto& all = given_forces();
  const std::lock_guard lock(all.mutex);
  const auto found = all.laws.find(effect.name);
  return found == all.laws.end() ? nullptr : found->second;
}

}  // namespace stiction::sim
