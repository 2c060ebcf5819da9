#include "host/log/mat_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/log/channel_name.hpp"
#include "host/log/mat_handles.hpp"
#include "host/log/mat_values.hpp"
#include "host/log/message.hpp"
#include "host/log/sampling.hpp"
#include "host/log/unit_scale.hpp"

namespace stiction::host {
namespace {

constexpr int digits_of_single = 7;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : name_(file.string()), file_(open_mat(name_)) {
    log_.source = name_;
  }

  Log read() {
    std::map<std::string, MatVariable> variables;
    while (MatVariable v{Mat_VarReadNext(file_.get())}) {
      if (v->name == nullptr) continue;
      std::string variable = v->name;
      variables[std::move(variable)] = std::move(v);
    }
    if (const auto units = variables.extract("units"); units && units.mapped()->class_type == MAT_C_STRUCT)
      read_units(*units.mapped());
    if (const auto comments = variables.extract("comments")) read_comments(text_of(comments.mapped().get()));
    read_time(variables);
    for (const auto& [variable, v] : variables) {
      if (v->class_type == MAT_C_STRUCT)
        read_axis(variable, *v);
      else if (!read_channel("", variable, v.get()))
        log_.ignored.push_back(variable);
    }
    share_channels(log_);
    kinds_.mark(log_);
    require_channels(log_, name_);
    check_sampling(log_, {0.0, time_digits_}, [&](std::size_t k) { return fmt::format("{}: t({})", name_, k + 1); });
    return std::move(log_);
  }

 private:
  void read_units(const matvar_t& units) {
    const auto count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&units));
    char* const* names = Mat_VarGetStructFieldnames(&units);
    for (unsigned k = 0; k < count; ++k)
      units_[names[k]] = text_of(Mat_VarGetStructFieldByIndex(const_cast<matvar_t*>(&units), k, 0));
  }

  void read_comments(const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const auto end = std::min(text.find('\n', at), text.size());
      const auto line = text.substr(at, end - at);
      const auto colon = line.find(": ");
      log_.comments.emplace_back(line.substr(0, colon), colon == std::string::npos ? "" : line.substr(colon + 2));
      at = end + 1;
    }
  }

  void read_time(std::map<std::string, MatVariable>& variables) {
    const auto t = variables.extract("t");
    if (!t) {
      for (const auto& [variable, v] : variables)
        if (v->class_type == MAT_C_STRUCT && Mat_VarGetStructFieldByName(v.get(), "t", 0) != nullptr)
          throw LogError(
              fmt::format("{}: found no variable t, but {}.t; expected the time as a variable of its own: "
                          "save(file, '-struct', '{}')",
                          name_, excerpt(variable), excerpt(variable)));
      throw LogError(
          name_ +
          ": found no variable t; expected the time of every sample, in s (--columns \"t[ms],x[mm],i[mA]\" names the "
          "columns of a matrix, `stiction convert --map` vectors)");
    }
    log_.t = values_of("t", time_scale(), t.mapped().get());
    if (t.mapped()->class_type == MAT_C_SINGLE) time_digits_ = digits_of_single;
    for (std::size_t k = 1; k < log_.t.size(); ++k)
      if (!(log_.t[k] > log_.t[k - 1]))
        throw LogError(
            fmt::format("{}: t({}): found {:.10g} s; expected a time after that of the sample before ({:.10g} "
                        "s)",
                        name_, k + 1, log_.t[k], log_.t[k - 1]));
  }

  void read_axis(const std::string& axis, matvar_t& v) {
    const auto count = Mat_VarGetNumberOfFields(&v);
    char* const* names = Mat_VarGetStructFieldnames(&v);
    const bool single = v.rank == 2 && v.dims[0] == 1 && v.dims[1] == 1;
    for (unsigned k = 0; k < count; ++k) {
      const std::string field = names[k];
      const auto* value = single ? Mat_VarGetStructFieldByIndex(&v, k, 0) : nullptr;
      if (value == nullptr || !read_channel(axis, field, value)) log_.ignored.push_back(axis + "." + field);
    }
  }

  bool read_channel(const std::string& axis, const std::string& name, const matvar_t* v) {
    const auto* channel = find_channel(name);
    if (channel == nullptr) return false;
    const auto full = axis.empty() ? name : axis + "." + name;
    auto values = values_of(full, scale_of(axis, full, name, *channel), v);
    if (values.size() != log_.t.size())
      throw LogError(fmt::format("{}: {}: found {} values; expected {}, as many as t has", name_, full, values.size(),
                                 log_.t.size()));
    axis_of(log_, axis).*channel->values = std::move(values);
    return true;
  }

  std::vector<double> values_of(const std::string& full, const UnitScale& scale, const matvar_t* v) const {
    const auto refuse = [&](const std::string& what) -> LogError {
      return LogError(fmt::format("{}: {}: found {}", name_, full, what));
    };
    if (v->isComplex != 0) throw refuse("complex numbers; expected real ones");
    const bool vector = v->rank == 2 && (v->dims[0] == 1 || v->dims[1] == 1);
    if (!vector) throw refuse(shape_of(*v) + " values; expected a row or a column");
    std::vector<double> values;
    values.reserve(v->dims[0] * v->dims[1]);
    const bool numbers = v->data != nullptr && with_numbers(*v, [&](const auto all) {
                           for (const auto value : all) values.push_back(scale(static_cast<double>(value)));
                         });
    if (!numbers) throw refuse("no numbers; expected an array of real numbers");
    for (std::size_t k = 0; k < values.size(); ++k)
      if (!std::isfinite(values[k]))
        throw LogError(fmt::format("{}: {}({}): found {}; expected a finite number", name_, full, k + 1, values[k]));
    return values;
  }

  UnitScale time_scale() const {
    const auto found = units_.find("t");
    if (found == units_.end()) return {};
    try {
      return {found->second, "s"};
    } catch (const machine::UnitError& error) {
      refuse_unit("t", found->second, error, "s");
    }
  }

  UnitScale scale_of(const std::string& axis, const std::string& full, const std::string& name,
                     const LogChannel& channel) {
    const bool torque = name != channel.name, force = channel.rotary_name == nullptr || name != channel.rotary_name;
    const auto found = units_.find(name);
    if (found == units_.end()) {  // SI units, of a rotary axis too
      kinds_.add(axis, torque ? AxisKind::rotary : force ? AxisKind::linear : AxisKind::either, full, name_);
      return {};
    }
    try {
      const auto [scale, kind] = channel_scale(channel, name, found->second);
      kinds_.add(axis, kind, fmt::format("{}[{}]", full, found->second), name_);
      return scale;
    } catch (const machine::UnitError& error) {
      refuse_unit(full, found->second, error, torque ? channel.rotary_unit : channel.unit);
    }
  }

  [[noreturn]] void refuse_unit(const std::string& full, const std::string& unit, const machine::UnitError& error,
                                const char* wanted) const {
    throw LogError(fmt::format("{}: {}: found the unit '{}' ({}); expected one like {}", name_, full, excerpt(unit),
                               excerpt(error.what(), 120), wanted));
  }

  std::string name_;
  MatFile file_;
  Log log_;
  AxisKinds kinds_;
  std::map<std::string, std::string> units_;
  int time_digits_ = 17;
};

// ---- writing

bool is_variable_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !name.empty() && name.size() < 64 && letter(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

// matio copies the data, though it does not take it as const.
MatVariable column(const char* name, const std::vector<double>& values) {
  std::size_t dims[2] = {values.size(), 1};
  return MatVariable(Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, const_cast<double*>(values.data()), 0));
}

MatVariable text(const char* name, const std::string& value) {
  std::size_t dims[2] = {1, value.size()};
  return MatVariable(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, dims, const_cast<char*>(value.data()), 0));
}

// One unit for the channels of that name of all axes: files have no other place for it.
const char* unit_of_all(const Log& log, const LogChannel& channel, const AxisLog& axis) {
  for (const auto& other : log.axes)
    if (other.rotary != axis.rotary && !(other.*channel.values).empty() &&
        std::string_view(name_on(other, channel)) == name_on(axis, channel) &&
        std::string_view(unit_on(other, channel)) != unit_on(axis, channel))
      throw LogError(fmt::format(
          "{}: found the linear axis {} and the rotary axis {}; expected axes of one kind in a MAT-file, "
          "which has one unit for {} of all axes (a CSV has one for each)",
          log.source, (axis.rotary ? other : axis).axis, (axis.rotary ? axis : other).axis, name_on(axis, channel)));
  return unit_on(axis, channel);
}

class Writer {
 public:
  Writer(const std::filesystem::path& file, MatLevel level)
      : name_(file.string()), compression_(level == MatLevel::level_5 ? MAT_COMPRESSION_ZLIB : MAT_COMPRESSION_NONE) {
    silence_matio();
    file_.reset(Mat_CreateVer(name_.c_str(), nullptr, level == MatLevel::level_5 ? MAT_FT_MAT5 : MAT_FT_MAT73));
    if (!file_) fail();
  }

  void write(const MatVariable& variable) {
    if (!variable || Mat_VarWrite(file_.get(), variable.get(), compression_) != 0) fail();
  }
  void write_struct(const char* name, std::vector<MatVariable> fields) {
    std::vector<const char*> names;
    for (const auto& field : fields) {
      if (!field) fail();
      names.push_back(field->name);
    }
    std::size_t dims[2] = {1, 1};
    const MatVariable whole(Mat_VarCreateStruct(name, 2, dims, names.data(), static_cast<unsigned>(names.size())));
    if (!whole) fail();
    for (std::size_t k = 0; k < fields.size(); ++k)
      Mat_VarSetStructFieldByIndex(whole.get(), k, 0, fields[k].release());  // it takes the field over
    write(whole);
  }
  void close() {
    if (Mat_Close(file_.release()) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const { throw std::runtime_error(name_ + ": cannot be written"); }

  std::string name_;
  matio_compression compression_;
  MatFile file_;
};

}  // namespace

bool is_mat_file(const std::filesystem::path& file, std::string_view first_bytes) {
  constexpr std::string_view hdf5 = "\x89HDF\r\n\x1a\n";
  return first_bytes.starts_with("MATLAB ") || first_bytes.starts_with(hdf5) || file.extension() == ".mat";
}

Log read_mat_log(const std::filesystem::path& file) { return Reader(file).read(); }

void write_mat_log(const std::filesystem::path& file, const Log& log, MatLevel level) {
  for (const auto& axis : log.axes)
    if (const auto& name = axis.axis;
        !name.empty() && (!is_variable_name(name) || name == "t" || name == "units" || name == "comments"))
      throw LogError(fmt::format("{}: found an axis named '{}'; expected a name that a MATLAB variable can have",
                                 log.source, name));
  Writer writer(file, level);
  writer.write(column("t", log.t));
  std::vector<MatVariable> units;
  units.push_back(text("t", "s"));
  std::set<std::string_view> stated;
  for (const auto& channel : log_channels)
    for (const auto& axis : log.axes)
      if (!(axis.*channel.values).empty() && stated.insert(name_on(axis, channel)).second)
        units.push_back(text(name_on(axis, channel), unit_of_all(log, channel, axis)));
  const auto endless = std::ranges::find_if(log.axes, [](const AxisLog& axis) { return !axis.phase.empty(); });
  if (endless != log.axes.end()) units.push_back(text(phase_name, phase_unit(*endless)));
  for (const auto& axis : log.axes) {
    std::vector<MatVariable> fields;
    for (const auto& channel : log_channels)
      if (const auto& values = axis.*channel.values; !values.empty())
        fields.push_back(column(name_on(axis, channel), values));
    if (!axis.phase.empty()) {
      std::vector<double> phase;
      for (std::size_t k = 0; k < axis.phase.size(); ++k) phase.push_back(shown_phase(axis, k));
      fields.push_back(column(phase_name, phase));
    }
    if (!axis.axis.empty())
      writer.write_struct(axis.axis.c_str(), std::move(fields));
    else
      for (const auto& field : fields) writer.write(field);
  }
  writer.write_struct("units", std::move(units));
  std::string comments;
  for (const auto& [key, value] : log.comments) comments += value.empty() ? key + "\n" : key + ": " + value + "\n";
  if (!comments.empty()) writer.write(text("comments", comments));
  writer.close();
}

}  // namespace stiction::host
