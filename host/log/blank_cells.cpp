#include "host/log/blank_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/log/channel_name.hpp"

namespace stiction::host {
namespace {

using Values = std::vector<double>;
using Member = Values AxisLog::*;

constexpr double slower_table = 0.2;  // of the rows without a position or an effort

bool blank(double value) { return std::isnan(value); }
bool any_blank(const Values& values) { return std::ranges::any_of(values, blank); }

// The channels that a row must have: position or speed, and the effort.
std::vector<Member> required(const AxisLog& axis) {
  std::vector<Member> members;
  for (const auto& choice :
       {std::vector<Member>{&AxisLog::x, &AxisLog::v}, std::vector<Member>{&AxisLog::i, &AxisLog::force, &AxisLog::u}})
    for (const Member member : choice)
      if (!(axis.*member).empty()) {
        members.push_back(member);
        break;
      }
  return members;
}

void keep_rows(Log& log, const std::vector<std::size_t>& rows) {
  const auto kept = [&](Values& values) {
    if (values.empty()) return;
    Values out;
    out.reserve(rows.size());
    for (const auto row : rows) out.push_back(values[row]);
    values = std::move(out);
  };
  kept(log.t);
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) kept(axis.*channel.values);
}

// Straight lines over blank cells, the next value at either end; true where a cell was blank.
std::vector<bool> fill(const Values& t, Values& values) {
  std::vector<bool> filled(values.size(), false);
  std::size_t last = values.size();
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (blank(values[k])) {
      filled[k] = true;
      continue;
    }
    const std::size_t from = last == values.size() ? 0 : last + 1;
    for (std::size_t m = from; m < k; ++m)
      values[m] = last == values.size()
                      ? values[k]
                      : values[last] + (values[k] - values[last]) * (t[m] - t[last]) / (t[k] - t[last]);
    last = k;
  }
  for (std::size_t m = last + 1; m < values.size(); ++m) values[m] = values[last];
  return filled;
}

}  // namespace

std::vector<std::size_t> treat_blank_cells(Log& log, const std::function<std::string(std::size_t)>& place) {
  std::vector<std::size_t> rows;
  const auto name = [](const AxisLog& axis, const LogChannel& channel) { return channel_header(axis.axis, channel); };
  for (auto& axis : log.axes)
    for (const auto& channel : log_channels) {
      auto& values = axis.*channel.values;
      if (values.empty() || !std::ranges::all_of(values, blank)) continue;
      values.clear();
      log.notes.push_back(fmt::format("{} has no value in any row and is taken as absent.", name(axis, channel)));
    }
  std::vector<bool> missing(log.t.size(), false);
  for (const auto& axis : log.axes)
    for (const Member member : required(axis))
      for (std::size_t k = 0; k < log.t.size(); ++k)
        if (blank((axis.*member)[k])) missing[k] = true;
  if (const auto first = std::ranges::find(missing, true); first != missing.end()) {
    std::size_t begin = 0, end = missing.size();
    while (begin < end && missing[begin]) ++begin;
    while (end > begin && missing[end - 1]) --end;
    if (end - begin < 2)
      throw LogError(fmt::format(
          "{}: found no row, or only one, in which position and effort are both there; expected both in the same rows",
          place(static_cast<std::size_t>(first - missing.begin()))));
    const auto inside = static_cast<std::size_t>(std::count(missing.begin() + static_cast<std::ptrdiff_t>(begin),
                                                            missing.begin() + static_cast<std::ptrdiff_t>(end), true));
    const bool drop = static_cast<double>(inside) > slower_table * static_cast<double>(end - begin);
    if (end - begin < missing.size())
      log.notes.push_back(
          fmt::format("{} rows before and {} behind the part that has both position and effort are left away.", begin,
                      missing.size() - end));
    if (drop)
      log.notes.push_back(fmt::format(
          "{} rows without position or effort are left away: the table is written faster than they are sampled.",
          inside));
    else if (inside > 0)
      log.notes.push_back(
          fmt::format("{} rows without position or effort are interpolated and used by no fit.", inside));
    if (drop || end - begin < missing.size()) {
      for (std::size_t k = begin; k < end; ++k)
        if (!drop || !missing[k]) rows.push_back(k);
      keep_rows(log, rows);
    }
  }
  for (auto& axis : log.axes) {
    const auto needed = required(axis);
    for (const auto& channel : log_channels) {
      auto& values = axis.*channel.values;
      if (values.empty() || !any_blank(values)) continue;
      if (std::ranges::all_of(values, blank)) {
        values.clear();
        continue;
      }
      const bool is_needed = std::ranges::find(needed, channel.values) != needed.end();
      const auto first = std::ranges::find_if_not(values, blank);
      const auto last = std::ranges::find_if_not(values.rbegin(), values.rend(), blank).base();
      const double covered = log.t[static_cast<std::size_t>(last - values.begin()) - 1] -
                             log.t[static_cast<std::size_t>(first - values.begin())];
      if (!is_needed && covered < 0.5 * (log.t.back() - log.t.front())) {
        values.clear();
        log.notes.push_back(
            fmt::format("{} covers less than half of the record and is taken as absent.", name(axis, channel)));
        continue;
      }
      const auto filled = fill(log.t, values);
      if (!is_needed) {
        log.notes.push_back(fmt::format("{} blank cells of {} are interpolated.", std::ranges::count(filled, true),
                                        name(axis, channel)));
        continue;
      }
      axis.left_out.resize(values.size(), false);
      for (std::size_t k = 0; k < filled.size(); ++k)
        if (filled[k]) axis.left_out[k] = true;
    }
  }
  return rows;
}

}  // namespace stiction::host
