#include "firmware/version/version.hpp"

#include "commit.hpp"

namespace stiction {

std::string program_version() { return STICTION_VERSION " (commit " STICTION_COMMIT ")"; }

}  // namespace stiction
