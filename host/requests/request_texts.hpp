// What a request says, option by option, and the machine it names.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/requests/request.hpp"
#include "host/simulate/machine_needs.hpp"

namespace stiction::host {

class RequestTexts {
 public:
  // Of `request`, which must outlive it.
  explicit RequestTexts(const Request& request) : request_(request) {}
  // The first value of the option `name`; `usual` where it is not given.
  std::string text(std::string_view name, std::string usual = {}) const;
  // All values of the option `name`.
  std::vector<std::string> all(std::string_view name) const;
  // Throws UsageError for a value of `name` that is neither true nor false; false where it is not given.
  bool flag(std::string_view name) const;
  // A whole number from `least` to `most`; `usual` where it is not given. Throws UsageError. `name`: of the option.
  std::uint64_t number(std::string_view name, std::uint64_t usual, std::uint64_t least, std::uint64_t most) const;

 private:
  const Request& request_;
};

// The machine of `request` as it is in `experiment`, with what the command `needs` and with the request's forces.
// Throws machine::MachineFileError, UsageError.
machine::Machine machine_of(const Request& request, const std::string& experiment, const MachineNeeds& needs);

}  // namespace stiction::host
