// Read once for all rooms of the desk, whose mathematics is Eigen's (toolchain/precompiled.cmake).
#pragma once

#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <complex>
#include <nlohmann/json.hpp>
#include <random>

#include "toolchain/precompiled/standard.hpp"
