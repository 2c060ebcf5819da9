// The fault table as a page of Markdown: docs/faults.md is printed from here.
#pragma once

#include <cstdint>
#include <string>

namespace stiction::drive {

// `period_ns`: of the fast loop, in which detection times are given.
std::string fault_page(std::int64_t period_ns = 62'500);

}  // namespace stiction::drive
