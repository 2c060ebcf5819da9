#include "host/report/origin.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "host/report/page.hpp"
#include "host/report/typeset.hpp"

namespace stiction::host {
namespace {

// The command line has their folders.
std::string file_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const auto& path : paths) names.push_back(std::filesystem::path(path).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

// "moving mass, level of Coulomb friction": titles within a sentence.
std::string listed(std::vector<std::string> titles) {
  for (auto& title : titles)
    if (title.size() > 1 && (title[1] == ' ' || std::islower(static_cast<unsigned char>(title[1]))))
      title[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
  return escape_html(typeset(fmt::format("{}", fmt::join(titles, ", "))));
}

}  // namespace

std::string present_date() {
  std::time_t now = std::time(nullptr);
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH")) {
    char* end = nullptr;
    const long long epoch = std::strtoll(given, &end, 10);
    if (end != given && *end == '\0') now = static_cast<std::time_t>(epoch);
  }
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now));
}

std::string sample_rates(const std::vector<double>& periods) {
  std::vector<std::string> rates;
  for (const double period : periods) {
    const double hertz = 1.0 / period;
    auto rate = hertz < 1e3 ? fmt::format("{:.5g} Hz ({:.5g} ms)", hertz, period * 1e3)
                            : fmt::format("{:.5g} kHz ({:.5g} µs)", hertz * 1e-3, period * 1e6);
    if (std::find(rates.begin(), rates.end(), rate) == rates.end()) rates.push_back(std::move(rate));
  }
  return fmt::format("{}", fmt::join(rates, ", "));
}

std::string origin_html(const Origin& origin, const std::string& machine, const std::string& command,
                        const std::string& version) {
  std::string items;
  const auto add = [&](const char* term, const std::string& text, const char* kind = "") {
    if (text.empty()) return;
    items += fmt::format("<div{}><dt>{}</dt><dd{}>{}</dd></div>", *kind == '\0' ? "" : " class=\"broad\"", term,
                         *kind == '\0' ? "" : fmt::format(" class=\"{}\"", kind), escape_html(text));
  };
  add("Date", origin.date.empty() ? present_date() : origin.date);
  add("Machine", machine);
  add("Machine file", file_names(origin.machine_files));
  add("Source files", origin.sources.empty() ? "none: a simulation" : file_names(origin.sources));
  add("Sample rate", sample_rates(origin.sample_periods));
  add("Version", "stiction " + version);
  add("Command line", command, "command");
  return items;
}

std::string abilities_html(const Origin& origin) {
  const char* logs = origin.sources.size() == 1 ? "This log" : "These logs";
  std::string html;
  for (const auto& axis : origin.abilities) {
    const auto of = axis.axis.empty() ? std::string() : fmt::format(" of axis {}", axis.axis);
    std::vector<std::string> missing;
    std::string rows;
    for (const auto& each : axis.open) {
      missing.push_back(each.what);
      rows += fmt::format("<li><strong>{}</strong>: {}{}.</li>", escape_html(typeset(each.what)),
                          escape_html(typeset(each.reason)),
                          each.record.empty() ? "" : "; record " + escape_html(typeset(each.record)));
    }
    for (const auto& suspicion : axis.suspicions)
      html += fmt::format("<p class=\"scope\"><strong>Check first{}:</strong> {}.</p>", escape_html(of),
                          escape_html(typeset(suspicion)));
    if (!axis.possible.empty())
      html += fmt::format("<p class=\"scope\"><strong>{} can determine{}:</strong> {}.</p>", logs, escape_html(of),
                          listed(axis.possible));
    if (!rows.empty())
      html += fmt::format(
          "<details class=\"scope\"><summary><strong>Cannot determine{}:</strong> {}</summary><ul>{}</ul></details>",
          escape_html(of), listed(missing), rows);
  }
  return html.empty() ? "" : fmt::format("<div class=\"abilities\">{}</div>\n", html);
}

}  // namespace stiction::host
