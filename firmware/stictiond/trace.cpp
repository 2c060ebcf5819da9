#include "firmware/stictiond/trace.hpp"

#include "firmware/machine/configuration/trace_writer.hpp"

namespace stiction::drive {

void Trace::write(const std::filesystem::path& file, const std::vector<std::string>& axes,
                  std::span<const std::string> comments) const {
  machine::TraceWriter writer(file, axes, comments);
  const std::span<const AxisSignals<FixedSignals>> all(signals_);
  for (std::size_t i = 0; i < rows(); ++i) writer.write(times_ns_[i], all.subspan(i * axes_, axes_));
  writer.close();
}

}  // namespace stiction::drive
