// MAT-files that are no logs by their names: one matrix with the names of its columns stated, or vectors and matrices
// that a mapping names. See mat_log.hpp and recording.hpp.
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "host/log/channel_name.hpp"
#include "host/log/mat_handles.hpp"
#include "host/log/mat_log.hpp"
#include "host/log/mat_values.hpp"
#include "host/log/message.hpp"
#include "host/log/recording.hpp"
#include "host/log/table_form.hpp"

namespace stiction::host {
namespace {

struct Matrix {
  std::string name;
  bool single = false;  // precision
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;  // column by column

  std::vector<double> column(std::size_t k) const {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(k * rows);
    return {begin, begin + static_cast<std::ptrdiff_t>(rows)};
  }
  Matrix transposed() const {
    Matrix t{name, single, columns, rows, {}};
    t.values.reserve(values.size());
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) t.values.push_back(values[c * rows + r]);
    return t;
  }
};

// All real matrices of the file that have more than one number, and those of structs one level down.
std::vector<Matrix> matrices_of(const std::string& file) {
  const MatFile mat = open_mat(file);
  std::vector<Matrix> matrices;
  const auto take = [&](const std::string& name, const matvar_t& v) {
    if (!is_real_matrix(v) || v.dims[0] * v.dims[1] < 2) return;
    Matrix matrix{name, v.class_type == MAT_C_SINGLE, v.dims[0], v.dims[1], {}};
    matrix.values.reserve(matrix.rows * matrix.columns);
    with_numbers(v, [&](const auto all) {
      for (const auto value : all) matrix.values.push_back(static_cast<double>(value));
    });
    if (matrix.values.size() == matrix.rows * matrix.columns) matrices.push_back(std::move(matrix));
  };
  while (MatVariable v{Mat_VarReadNext(mat.get())}) {
    if (v->name == nullptr) continue;
    take(v->name, *v);
    if (v->class_type != MAT_C_STRUCT || v->rank != 2 || v->dims[0] != 1 || v->dims[1] != 1) continue;
    char* const* names = Mat_VarGetStructFieldnames(v.get());
    for (unsigned k = 0; k < Mat_VarGetNumberOfFields(v.get()); ++k)
      if (const auto* field = Mat_VarGetStructFieldByIndex(v.get(), k, 0))
        take(fmt::format("{}.{}", v->name, names[k]), *field);
  }
  return matrices;
}

std::string list_of(const std::vector<Matrix>& matrices) {
  std::string list;
  for (const auto& matrix : matrices)
    if (list.size() < 200)
      list += fmt::format("{}{} ({}x{})", list.empty() ? "" : ", ", excerpt(matrix.name), matrix.rows, matrix.columns);
  return list.empty() ? "no array of real numbers" : list;
}

Matrix matrix_with(std::size_t columns, const std::string& file) {
  auto all = matrices_of(file);
  std::vector<Matrix> fit;
  for (const auto& matrix : all)
    if (matrix.columns == columns || matrix.rows == columns)
      fit.push_back(matrix.columns == columns ? matrix : matrix.transposed());
  if (fit.size() != 1)
    throw LogError(
        fmt::format("{}: found {}; expected one matrix with {} columns, as --columns names so many (a "
                    "mapping file names single vectors)",
                    file, list_of(all), columns));
  return std::move(fit.front());
}

// Values of the column in SI units. `place`: "FILE: M(:,2)", for messages.
std::vector<double> scaled(std::vector<double> values, const UnitScale& scale, const std::string& place) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = scale(values[k]);
    if (!std::isfinite(values[k]))
      throw LogError(fmt::format("{}, row {}: found {}; expected a finite number", place, k + 1, values[k]));
  }
  return values;
}

}  // namespace

Log read_mat_columns(const std::filesystem::path& file, std::string_view columns) {
  const auto names = column_names(columns);
  const auto matrix = matrix_with(names.size(), file.string());
  Log log;
  log.source = file.string();
  AxisKinds kinds;
  std::set<std::string> seen;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto split = split_channel_name(names[k]);
    const auto* channel = find_channel(split.name);
    const bool time = split.axis.empty() && split.name == "t";
    if (!time && channel == nullptr) {
      log.ignored.emplace_back(names[k]);
      continue;
    }
    const auto place = fmt::format("{}: {}(:,{}), {}", log.source, excerpt(matrix.name), k + 1, excerpt(names[k]));
    if (!seen.insert(fmt::format("{}.{}", split.axis, time ? "t" : channel->name)).second)
      throw LogError(place + ": found this name a second time; expected it once");
    try {
      const auto [scale, kind] =
          time ? ChannelScale{{split.unit, "s"}, AxisKind::either} : channel_scale(*channel, split.name, split.unit);
      kinds.add(split.axis, kind, names[k], place);
      (time ? log.t : axis_of(log, split.axis).*channel->values) = scaled(matrix.column(k), scale, place);
    } catch (const machine::UnitError& error) {
      throw LogError(fmt::format("{}: found [{}] ({}); expected a unit like that of {}[{}]", place, excerpt(split.unit),
                                 excerpt(error.what(), 120), split.name, time ? "s" : channel->unit));
    }
  }
  if (!seen.contains(".t"))
    throw LogError(log.source + ": --columns: found no t[s]; expected the time of every sample");
  for (std::size_t k = 1; k < log.t.size(); ++k)
    if (!(log.t[k] > log.t[k - 1]))
      throw LogError(
          fmt::format("{}: {}, row {}: found {:.10g} s; expected a time after that of the sample before "
                      "({:.10g} s)",
                      log.source, excerpt(matrix.name), k + 1, log.t[k], log.t[k - 1]));
  share_channels(log);
  kinds.mark(log);
  require_channels(log, log.source + ": --columns");
  check_sampling(log, {0.0, matrix.single ? 7 : 17},
                 [&](std::size_t k) { return fmt::format("{}: {}, row {}", log.source, excerpt(matrix.name), k + 1); });
  return log;
}

Recording read_mat_recording(const std::filesystem::path& file, const TableForm& form) {
  Recording recording;
  recording.source = file.string();
  recording.kind = "a table";
  const auto matrices = matrices_of(recording.source);
  std::vector<double> t;
  const auto is_time = [&](const std::string& name) { return !form.time_column.empty() && name == form.time_column; };
  // A vector is a channel of its name, a matrix has M(:,1), M(:,2), ...
  for (const auto& matrix : matrices) {
    const bool vector = matrix.rows == 1 || matrix.columns == 1;
    const auto columns = vector ? 1 : matrix.columns;
    for (std::size_t k = 0; k < columns; ++k) {
      RecordedChannel channel;
      channel.name = vector ? matrix.name : fmt::format("{}(:,{})", matrix.name, k + 1);
      channel.values = vector ? matrix.values : matrix.column(k);
      if (is_time(channel.name)) {
        t = std::move(channel.values);
        if (matrix.single) recording.digits.significant = 7;
        continue;
      }
      for (std::size_t row = 0; row < channel.values.size() && channel.bad.empty(); ++row)
        if (!std::isfinite(channel.values[row]))
          channel.bad = fmt::format("{}: {}, row {}: found {}", recording.source, excerpt(channel.name), row + 1,
                                    channel.values[row]);
      recording.channels.push_back(std::move(channel));
    }
  }
  if (!form.time_column.empty() && t.empty())
    throw LogError(fmt::format("{}: found no vector '{}' among {}; expected the time that the mapping names",
                               recording.source, excerpt(form.time_column), list_of(matrices)));
  UnitScale scale;
  if (!t.empty()) try {
      scale = UnitScale(form.time_unit.empty() ? "s" : std::string_view(form.time_unit), "s");
    } catch (const machine::UnitError& error) {
      throw LogError(fmt::format("{}: {}: found the unit '{}' ({}); expected one like s in [time] of the mapping",
                                 recording.source, excerpt(form.time_column), excerpt(form.time_unit),
                                 excerpt(error.what(), 120)));
    }
  for (double& value : t) value = scale(value);
  // Other lengths than the time's are no samples of it: constants, tables.
  std::erase_if(recording.channels, [&](const auto& c) { return !t.empty() && c.values.size() != t.size(); });
  for (auto& channel : recording.channels) {
    channel.t = t;
    if (t.empty())
      for (std::size_t k = 0; k < channel.values.size(); ++k) channel.t.push_back(static_cast<double>(k) * form.period);
  }
  return recording;
}

}  // namespace stiction::host
