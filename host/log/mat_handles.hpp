// matio's files and variables, owned. Only the .cpp files of this folder may include it.
#pragma once

#include <matio.h>

#include <memory>
#include <string>

#include "host/log/log.hpp"

namespace stiction::host {

struct MatFree {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, MatFree>;
using MatVariable = std::unique_ptr<matvar_t, MatFree>;

// matio prints what it finds wrong on standard error; our own messages say it.
inline void silence_matio() {
  Mat_LogInitFunc("stiction", [](int, auto*) {});  // char* before matio 1.5.28, const char* since
}

// The opened file, never null. Throws LogError.
inline MatFile open_mat(const std::string& file) {
  silence_matio();
  MatFile opened(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (!opened) throw LogError(file + ": found a different format; expected a MAT-file of level 5 or 7.3");
  return opened;
}

}  // namespace stiction::host
