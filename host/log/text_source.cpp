#include "host/log/text_source.hpp"

#include <fmt/format.h>
#include <iconv.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>

#include "host/log/log.hpp"
#include "host/log/message.hpp"
#include "host/log/text_file.hpp"

namespace stiction::host {
namespace {

constexpr std::size_t piece = std::size_t{1} << 20;
constexpr std::size_t largest_whole = std::size_t{2} << 30;

struct GzipFree {
  void operator()(gzFile file) const { gzclose(file); }
};

// zlib reads a file without gzip's mark as it is.
class GzipFile {
 public:
  GzipFile(const std::filesystem::path& file, std::string_view expected) : name_(file.string()) {
    file_.reset(gzopen(file.c_str(), "rb"));
    if (!file_) fail(expected);
    gzbuffer(file_.get(), 1 << 17);
    // A folder opens, and refuses to be read.
    if (const int first = gzgetc(file_.get()); first != -1)
      gzungetc(first, file_.get());
    else if (gzeof(file_.get()) == 0)
      fail(expected);
  }

  std::size_t read(char* to, std::size_t count) {
    const int got = gzread(file_.get(), to, static_cast<unsigned>(count));
    int error = Z_OK;
    const char* why = gzerror(file_.get(), &error);
    // What was unpacked before the damage is no record of its own.
    if (got < 0 || (error != Z_OK && error != Z_STREAM_END))
      throw LogError(fmt::format("{}: found a damaged gzip archive ({}); expected a whole one", name_,
                                 error == Z_BUF_ERROR ? "it ends too early" : excerpt(why, 80)));
    return static_cast<std::size_t>(got);
  }

  std::size_t offset() const {
    const auto at = gzoffset(file_.get());
    return at > 0 ? static_cast<std::size_t>(at) : 0;
  }

 private:
  // Reading it in the usual way says what is wrong with it.
  [[noreturn]] void fail(std::string_view expected) const {
    const auto text = read_text_file(name_, expected);
    throw LogError(fmt::format("{}: found a damaged gzip archive; expected {}", name_, expected));
  }

  std::string name_;
  std::unique_ptr<gzFile_s, GzipFree> file_;
};

// UTF-16 to UTF-8, piece by piece.
class Utf16 {
 public:
  explicit Utf16(const char* encoding) : handle_(iconv_open("UTF-8", encoding)) {}
  Utf16(const Utf16&) = delete;
  Utf16& operator=(const Utf16&) = delete;
  ~Utf16() {
    if (valid()) iconv_close(handle_);
  }

  // Appends `bytes` to `text`; a character that is cut in two waits for the next ones. False: no UTF-16.
  bool append(std::string_view bytes, std::string& text) {
    waiting_.append(bytes);
    char* from = waiting_.data();
    std::size_t left = waiting_.size();
    char out[1 << 14];
    while (left > 0) {
      char* to = out;
      std::size_t room = sizeof out;
      const bool stopped = !valid() || iconv(handle_, &from, &left, &to, &room) == static_cast<std::size_t>(-1);
      const int why = errno;
      text.append(out, sizeof out - room);
      if (!stopped) break;
      if (!valid() || why == EILSEQ) return false;
      if (why == EINVAL) break;
    }
    waiting_.erase(0, waiting_.size() - left);
    return true;
  }
  bool is_complete() const { return waiting_.empty(); }

 private:
  bool valid() const { return handle_ != reinterpret_cast<iconv_t>(-1); }
  iconv_t handle_;
  std::string waiting_;
};

// The encoding that a byte-order mark of UTF-16 names; null for any other begin.
const char* utf16_of(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return "UTF-16LE";
  return bytes.starts_with("\xFE\xFF") ? "UTF-16BE" : nullptr;
}

[[noreturn]] void refuse_utf16(const std::string& name) {
  throw LogError(name + ": found text that begins as UTF-16 and is none; expected UTF-8 or UTF-16");
}

// `bytes` with UTF-16 turned into UTF-8; `whole`: not only the begin of a file, whose last character may be cut.
std::string as_utf8(std::string bytes, const std::string& name, bool whole) {
  const char* encoding = utf16_of(bytes);
  if (encoding == nullptr) return bytes;
  Utf16 utf16(encoding);
  std::string text;
  if (!utf16.append(std::string_view(bytes).substr(2), text) || (whole && !utf16.is_complete())) refuse_utf16(name);
  return text;
}

}  // namespace

struct TextSource::State {
  std::string name;
  std::function<std::size_t(char*, std::size_t)> read;
  std::unique_ptr<Utf16> utf16;
  std::string block;    // handed out last, and behind `end` the begin of the next
  std::size_t end = 0;  // of what was handed out
  bool begun = false, over = false;

  // Appends up to a piece of text to the block.
  void fill() {
    std::string bytes(piece, '\0');
    bytes.resize(read(bytes.data(), bytes.size()));
    if (bytes.empty()) over = true;
    std::string_view rest = bytes;
    if (!begun) rest.remove_prefix(take_mark(rest));
    begun = true;
    if (!utf16) {
      block.append(rest);
      return;
    }
    if (!utf16->append(rest, block) || (over && !utf16->is_complete())) refuse_utf16(name);
  }

  // The length of the byte-order mark.
  std::size_t take_mark(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) return 3;
    const char* encoding = utf16_of(bytes);
    if (encoding != nullptr) utf16 = std::make_unique<Utf16>(encoding);
    return encoding != nullptr ? 2 : 0;
  }
};

TextSource::TextSource(std::string_view text, std::string name) : state_(std::make_unique<State>()) {
  state_->name = std::move(name);
  state_->read = [text](char* to, std::size_t count) mutable {
    count = text.copy(to, std::min(count, text.size()));
    text.remove_prefix(count);
    return count;
  };
}

TextSource::TextSource(const std::filesystem::path& file, BytesRead progress) : state_(std::make_unique<State>()) {
  state_->name = file.string();
  state_->read = [source = std::make_shared<GzipFile>(file, "a log"), progress = std::move(progress),
                  told = std::size_t{0}](char* to, std::size_t count) mutable {
    const auto got = source->read(to, count);
    if (const auto at = source->offset(); progress && at > told) {
      progress(at - told);
      told = at;
    }
    return got;
  };
}

TextSource::TextSource(TextSource&&) noexcept = default;
TextSource::~TextSource() = default;

std::string_view TextSource::next() {
  auto& s = *state_;
  s.block.erase(0, s.end);
  std::size_t scanned = 0, cut = 0;
  bool quoted = false;
  while (!s.over) {
    s.fill();
    for (; scanned < s.block.size(); ++scanned) {
      if (s.block[scanned] == '"') quoted = !quoted;
      if (s.block[scanned] == '\n' && !quoted) cut = scanned + 1;
    }
    if (cut > 0) break;
    if (s.block.size() > longest_row)
      throw LogError(
          fmt::format("{}: found a row of more than {} MiB; expected the rows of a table", s.name, longest_row >> 20));
  }
  s.end = s.over ? s.block.size() : cut;
  return std::string_view(s.block).substr(0, s.end);
}

std::string read_plain_or_gzip(const std::filesystem::path& file, std::string_view expected) {
  GzipFile source(file, expected);
  std::string text;
  for (std::size_t size = 0;; size = text.size()) {
    text.resize(size + piece);
    const auto got = source.read(text.data() + size, piece);
    text.resize(size + got);
    if (got == 0) return as_utf8(std::move(text), file.string(), true);
    if (text.size() > largest_whole)
      throw LogError(fmt::format("{}: found more than {} GiB; expected {} of a smaller size", file.string(),
                                 largest_whole >> 30, expected));
  }
}

std::string first_bytes(const std::filesystem::path& file, std::size_t count) {
  GzipFile source(file, "a log");
  std::string bytes(count, '\0');
  bytes.resize(source.read(bytes.data(), count));
  return as_utf8(std::move(bytes), file.string(), false);
}

}  // namespace stiction::host
