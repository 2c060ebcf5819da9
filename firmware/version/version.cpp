#include "firmware/version/version.hpp"

#include <stiction_commit.hpp>  // made by commit.cmake

namespace stiction {

std::string program_version() { return STICTION_VERSION " (commit " STICTION_COMMIT ")"; }

}  // namespace stiction
