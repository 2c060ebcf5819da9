// Values as a machine file has them, in its own units: what the keys of a sweep that are relative multiply.
#pragma once

#include <string>
#include <vector>

#include "firmware/machine/file/document.hpp"

namespace stiction::host {

class MachineValues {
 public:
  // The machine `name`, shipped or a path, with the overrides of `experiment`. Throws machine::MachineFileError.
  MachineValues(const std::string& name, const std::string& experiment);

  // The assignments "KEY=VALUE" that multiply the value of `key` by `factor`, one for each axis where the key begins
  // with "axis.*."; an axis of these without the key is left alone. A list is multiplied as a whole. Throws
  // machine::MachineFileError where the file has no such value, or one that is no quantity.
  std::vector<std::string> multiplied(const std::string& key, double factor) const;

 private:
  std::string file_;
  machine::Document document_;
};

}  // namespace stiction::host
