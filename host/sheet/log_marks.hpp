// What a machine file says of the logs that it was made from: marks beside the values that they gave, remarks on what
// they say beside the sheet's, and what no question of a sheet asks for.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stiction::host {

// A value in SI units of the axis, with its comment.
struct MarkedValue {
  double value = 0.0;
  std::string comment;
};

struct LogMarks {
  std::map<std::string, std::string, std::less<>> comments;              // by question: of an answer of the logs
  std::map<std::string, std::vector<std::string>, std::less<>> remarks;  // by question: lines above its key
  std::optional<MarkedValue> period;                                     // s, of the samples; none: the shipped periods
  std::optional<MarkedValue> constant;       // N or N m, what acts on the axis at all times, positive in +x
  std::optional<MarkedValue> moment;         // N m of a weight that turns; negative: its rest is at half a turn
  std::optional<MarkedValue> load_friction;  // over the moment of the weight
  std::vector<std::string> weight;           // lines on constant force and weight that are not in the file
  double effort = 0.0;                       // A amplitude or V, the largest of the logs
  bool any = false;                          // whether there was a log at all
};

}  // namespace stiction::host
