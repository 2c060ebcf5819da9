// The plants of the page have no forces of a caller; and the page is one thread, without the lock that their list has.
#include "sim/effects/given_force.hpp"

namespace stiction::sim {

std::shared_ptr<const GivenForce::Law> given_force(const machine::Effect&) { return nullptr; }

}  // namespace stiction::sim
