// Writes the cascade's signals as a log: CSV (RFC 4180), leading "# key: value" lines, one header row "X.x_set[m]",
// one row a tick. The columns come from the one list of signals (axis_signals.hpp).
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/machine/configuration/conversion.hpp"
#include "stiction/drive/axis_signals.hpp"

namespace stiction::machine {

class TraceWriter {
 public:
  // `axes`: their names, in the order of the signals. `comments`: "key: value" lines. `force_sources`: of each axis
  // whether its motor is one, driven by a voltage in the place of a current; empty: none is. Throws std::runtime_error
  // when the file cannot be written.
  TraceWriter(const std::filesystem::path& file, std::vector<std::string> axes, std::span<const std::string> comments,
              std::vector<bool> force_sources = {})
      : name_(file.string()),
        axes_(std::move(axes)),
        force_sources_(std::move(force_sources)),
        file_(std::fopen(file.c_str(), "w")) {
    if (file_ == nullptr) throw std::runtime_error(name_ + ": cannot be written");
    for (const auto& comment : comments) buffer_ += "# " + comment + "\n";
  }
  TraceWriter(const TraceWriter&) = delete;
  TraceWriter& operator=(const TraceWriter&) = delete;
  ~TraceWriter() {
    if (file_ != nullptr) std::fclose(file_);
  }

  template <class S>
  void write(std::int64_t now_ns, std::span<const AxisSignals<S>> signals) {
    if (!header_written_) write_header(signals);
    auto out = std::back_inserter(buffer_);
    fmt::format_to(out, "{:.7f}", static_cast<double>(now_ns) * 1e-9);
    for (const auto& s : signals) {
      for_each_signal(s, [&](auto, auto, auto, auto value) { fmt::format_to(out, ",{:.10g}", to_si(value)); });
      fmt::format_to(out, ",{:d},{:d},{:d},{:d}", s.limiting.velocity, s.limiting.current, s.limiting.voltage,
                     static_cast<int>(s.fault));
    }
    buffer_ += '\n';
    if (buffer_.size() > (1u << 16)) flush();
  }

  // Completes the file. Throws std::runtime_error when the disk did not take all of it.
  void close() {
    flush();
    const bool failed = std::fclose(file_) != 0;
    file_ = nullptr;
    if (failed) throw std::runtime_error(name_ + ": could not be completed");
  }

 private:
  template <class S>
  void write_header(std::span<const AxisSignals<S>> signals) {
    buffer_ += "t[s]";
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const bool force_source = i < force_sources_.size() && force_sources_[i];
      for_each_signal(signals[i], [&](std::string_view name, std::string_view unit, auto, auto) {
        if (force_source && unit == "A") {
          unit = "V";
          // A log has the channel u for the commanded voltage.
          if (name == "i_set" || name == "i") name = name == "i_set" ? "u" : "u_motor";
        }
        buffer_ += fmt::format(",{}.{}[{}]", axes_[i], name, unit);
      });
      for (const char* flag : {"limiting_velocity", "limiting_current", "limiting_voltage", "fault"})
        buffer_ += fmt::format(",{}.{}[1]", axes_[i], flag);
    }
    buffer_ += '\n';
    header_written_ = true;
  }
  void flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size())
      throw std::runtime_error(name_ + ": could not be written");
    buffer_.clear();
  }

  std::string name_;
  std::vector<std::string> axes_;
  std::vector<bool> force_sources_;
  std::FILE* file_;
  std::string buffer_;
  bool header_written_ = false;
};

}  // namespace stiction::machine
