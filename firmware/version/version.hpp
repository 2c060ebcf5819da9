// Which version of the programmes this is.
#pragma once

#include <string>

namespace stiction {

// "0.1.0 (commit b8ff57e)": the project's version and the commit that was built, with "-dirty" where files differ from
// it; "commit unknown" for sources without their repository.
std::string program_version();

}  // namespace stiction
