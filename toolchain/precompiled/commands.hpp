// Read once for all commands of a programme (toolchain/precompiled.cmake).
#pragma once

#include <CLI/CLI.hpp>

#include "toolchain/precompiled/desk.hpp"
