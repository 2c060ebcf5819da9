// The columns of sweep.npz.
#include <algorithm>

#include "host/sweep/npz.hpp"
#include "host/sweep/results.hpp"

namespace stiction::host {
void write_table(const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan, const ChunkFiles& files,
                 const std::filesystem::path& place) {
  NpzWriter table(place);
  for (std::size_t k = 0; k < spec.keys.size(); ++k) {
    const auto& key = spec.keys[k];
    if (key.numeric) {
      table.add_numbers(key.column(), plan.rows, [&rows, &plan, k] {
        std::vector<double> numbers(plan.rows);
        for (std::uint64_t row = 0; row < plan.rows; ++row) numbers[row] = rows.values(row).numbers[k];
        return numbers;
      });
    } else {
      std::size_t longest = 0;
      for (const auto& text : key.values) longest = std::max(longest, code_points(text).size());
      table.add_texts(key.column(), plan.rows, longest,
                      [&rows, k](std::uint64_t row) { return rows.values(row).texts[k]; });
    }
  }
  for (std::size_t f = 0; f < plan.figures.size(); ++f)
    table.add_numbers(plan.figures[f].column(), plan.rows, [&files, f] { return files.column(f); });
  // Messages of failed runs may all differ, by the time of a fault.
  std::vector<std::uint8_t> status;
  std::vector<std::string> messages;
  std::vector<std::uint64_t> failed;
  std::size_t longest_message = 0;
  files.for_each([&](std::uint64_t chunk, const ChunkResult& result) {
    for (std::size_t k = 0; k < result.status.size(); ++k) {
      status.push_back(static_cast<std::uint8_t>(result.status[k]));
      if (result.message[k].empty()) continue;
      failed.push_back(files.first_row(chunk) + k);
      messages.push_back(result.message[k]);
      longest_message = std::max(longest_message, code_points(result.message[k]).size());
    }
  });
  constexpr std::size_t longest_status = 6;
  table.add_texts("status", plan.rows, longest_status,
                  [&status](std::uint64_t row) { return status[row] == 0 ? "done" : "failed"; });
  table.add_texts("message", plan.rows, longest_message, [&](std::uint64_t row) {
    const auto found = std::lower_bound(failed.begin(), failed.end(), row);
    if (found == failed.end() || *found != row) return std::string();
    return messages[static_cast<std::size_t>(found - failed.begin())];
  });
  std::size_t longest_command = 0;
  for (std::uint64_t row = 0; row < plan.rows; ++row)
    longest_command = std::max(longest_command, code_points(rows.command_line(rows.row(row))).size());
  table.add_texts("command", plan.rows, longest_command,
                  [&rows](std::uint64_t row) { return rows.command_line(rows.row(row)); });
  table.commit();
}

}  // namespace stiction::host
