// Servo traces of SINUMERIK Operate: see recording.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <pugixml.hpp>
#include <string>

#include "host/log/message.hpp"
#include "host/log/recording.hpp"

namespace stiction::host {
namespace {

std::size_t line_of(std::string_view text, std::ptrdiff_t offset) {
  const auto count = std::min(text.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, offset)));
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, count), '\n'));
}

// Counts lines on, from one record to the next.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  std::size_t at(std::ptrdiff_t offset) {
    const auto end = std::min(text_.size(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, offset)));
    for (; from_ < end; ++from_) line_ += text_[from_] == '\n';
    return line_;
  }

 private:
  std::string_view text_;
  std::size_t from_ = 0, line_ = 1;
};

}  // namespace

bool is_trace_xml(std::string_view begin) {
  if (begin.starts_with("\xEF\xBB\xBF")) begin.remove_prefix(3);
  const auto first = begin.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && begin[first] == '<';
}

Recording read_trace_xml(std::string_view text, const std::string& name) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    throw LogError(fmt::format("{}:{}: found no valid XML ({}); expected the servo trace of a SINUMERIK", name,
                               line_of(text, parsed.offset), parsed.description()));
  const auto root = document.document_element();
  if (std::string_view(root.name()).starts_with("ResponseTest"))
    throw LogError(
        fmt::format("{}: found a response test of a SINUMERIK, whose records are too short for a log; expected "
                    "`stiction simulate frequency-response --from FILE`, which evaluates it",
                    name));
  const auto frame = root.child("traceData").child("dataFrame");
  if (!frame)
    throw LogError(
        fmt::format("{}: found the element <{}> without traceData and dataFrame; expected the servo trace of a "
                    "SINUMERIK",
                    name, excerpt(root.name())));
  Recording recording;
  recording.source = name;
  recording.kind = "a servo trace of a SINUMERIK";
  recording.digits.significant = 0;
  std::map<std::string_view, pugi::xml_node> described;
  for (const auto signal : root.child("traceDisplaySetup").child("signals").children())
    described[signal.attribute("key").value()] = signal;
  // The signals of the frame are f1, f2, ... in their order.
  for (const auto& found : frame.select_nodes(".//dataSignal")) {
    const auto signal = described[found.node().attribute("key").value()];
    auto& channel = recording.channels.emplace_back();
    channel.name = signal.attribute("name").value();
    if (channel.name.empty()) channel.name = signal.attribute("description").value();
    if (channel.name.empty()) channel.name = fmt::format("f{}", recording.channels.size());
  }
  Lines lines(text);
  for (const auto& found : frame.select_nodes(".//rec")) {
    const auto record = found.node();
    const auto line = lines.at(record.offset_debug());
    const std::string_view stamp = record.attribute("time").value();
    double t = 0.0;
    if (!parse_number(stamp, '.', t))
      throw LogError(
          fmt::format("{}:{}: found the time '{}'; expected a number of seconds", name, line, excerpt(stamp)));
    count_digits(stamp, recording.digits, 1.0);
    for (std::size_t k = 0; k < recording.channels.size(); ++k) {
      auto& channel = recording.channels[k];
      const auto value = record.attribute(fmt::format("f{}", k + 1).c_str());
      if (!value || !channel.bad.empty()) continue;
      double number = 0.0;
      if (!parse_number(value.value(), '.', number)) {
        channel.bad = fmt::format("{}:{}: {}: found '{}'", name, line, excerpt(channel.name), excerpt(value.value()));
        continue;
      }
      channel.t.push_back(t);
      channel.values.push_back(number);
      channel.lines.push_back(line);
    }
  }
  return recording;
}

}  // namespace stiction::host
