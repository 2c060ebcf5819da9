#include "host/requests/request_texts.hpp"

#include <fmt/format.h>

#include <charconv>

#include "host/requests/given_force.hpp"
#include "host/requests/usage_error.hpp"
#include "host/simulate/loaded_machine.hpp"

namespace stiction::host {

std::string RequestTexts::text(std::string_view name, std::string usual) const {
  for (const auto& [key, value] : request_.options)
    if (key == name) return value;
  return usual;
}

std::vector<std::string> RequestTexts::all(std::string_view name) const {
  std::vector<std::string> values;
  for (const auto& [key, value] : request_.options)
    if (key == name) values.push_back(value);
  return values;
}

bool RequestTexts::flag(std::string_view name) const {
  const auto found = text(name, "false");
  if (found != "true" && found != "false")
    throw UsageError(fmt::format("--{}: found '{}'; expected true or false", name, found));
  return found == "true";
}

std::uint64_t RequestTexts::number(std::string_view name, std::uint64_t usual, std::uint64_t least,
                                   std::uint64_t most) const {
  const auto found = text(name);
  if (found.empty()) return usual;
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), number);
  if (error == std::errc() && end == found.data() + found.size() && number >= least && number <= most) return number;
  throw UsageError(fmt::format("--{}: found '{}'; expected a whole number from {} to {}", name, found, least, most));
}

machine::Machine machine_of(const Request& request, const std::string& experiment, const MachineNeeds& needs) {
  const RequestTexts texts(request);
  auto set = request.set;
  if (const auto kind = texts.text("compensation"); !kind.empty()) set.push_back(compensation_assignment(kind));
  auto machine =
      load_machine(request.machine, set, experiment, needs, needs.one_axis ? texts.text("axis") : std::string());
  add_forces(machine, request.forces);
  return machine;
}

}  // namespace stiction::host
