#include "compensation/injector/row_pipe.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "base/errors.hpp"

namespace driftwright::compensation {

using compensation::Lines;

namespace {

bool is_bit(char c) {
  return c == '0' || c == '1';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

}  // namespace

void RowReader::take_line(const char* begin, const char* end) {
  ++n_lines_;
  if (is_strict_) return take_good_line(begin, end);
  try {
    take_good_line(begin, end);
  } catch (const InputError& e) {
    faults_.emplace_back(e.what());
    if (n_columns_ != 0) rows_.push_back(last_);
  }
  if (!rows_.empty()) last_ = rows_.back();
}

void RowReader::take_good_line(const char* begin, const char* end) {
  const std::string_view line(begin, static_cast<std::size_t>(end - begin));
  if (n_columns_ == 2 && line.size() == 3 && is_bit(begin[0]) && begin[1] == ' ' && is_bit(begin[2])) {  // the usual case
    rows_.push_back(static_cast<Lines>((begin[0] & 1) | (begin[2] & 1) << 1));
    return;
  }
  Lines lines = 0;
  int n = 0;
  bool good = true;
  for (const char* c = begin; c != end && good;) {
    if (is_blank(*c) || (*c == '\r' && c + 1 == end)) {
      ++c;
      continue;
    }
    good = is_bit(*c) && n < 3 && (c + 1 == end || is_blank(c[1]) || c[1] == '\r');
    if (good) lines |= static_cast<Lines>((*c++ & 1) << n++);
  }
  good = good && n >= 2;
  if (good && n_columns_ == 0) n_columns_ = n;
  if (!good || n != n_columns_) {
    throw InputError(fmt::format("standard input, line {}: '{}' must be {} of 0 and 1, A B{}", n_lines_, line.substr(0, 60),
                                 n_columns_ == 0 ? "two or three columns" : fmt::format("{} columns", n_columns_),
                                 n_columns_ == 2 ? "" : " index"));
  }
  rows_.push_back(lines);
}

std::span<const Lines> RowReader::next() {
  if (error_) std::rethrow_exception(error_);
  rows_.clear();
  bytes_.clear();
  faults_.clear();
  std::array<char, 65536> bytes;
  while (rows_.empty() && !at_end_) {
    const ssize_t n = ::read(file_, bytes.data(), bytes.size());
    if (n < 0) {
      if (errno == EINTR) continue;
      throw InputError(fmt::format("standard input: {}", std::strerror(errno)));
    }
    const std::string held = rest_;
    const char* begin = bytes.data();  // of the first line not processed yet
    const auto keep_taken = [&] {
      bytes_.assign(held).append(bytes.data(), static_cast<std::size_t>(begin - bytes.data()));
    };
    try {
      if (n == 0) {
        at_end_ = true;
        if (!rest_.empty()) take_line(rest_.data(), rest_.data() + rest_.size());
        bytes_ = rest_;
        break;
      }
      const char* const end = begin + n;
      while (const char* newline =
                 static_cast<const char*>(std::memchr(begin, '\n', static_cast<std::size_t>(end - begin)))) {
        if (rest_.empty()) {
          take_line(begin, newline);
        } else {
          rest_.append(begin, newline);
          take_line(rest_.data(), rest_.data() + rest_.size());
          rest_.clear();
        }
        begin = newline + 1;
      }
      keep_taken();
      rest_.append(begin, end);
      constexpr std::size_t kLongestLine = 4096;
      if (rest_.size() > kLongestLine) {
        const std::string why =
            fmt::format("standard input, line {}: longer than {} characters", n_lines_ + 1, kLongestLine);
        if (is_strict_) throw InputError(why);
        if (!is_endless_) faults_.push_back(why);
        is_endless_ = true;
        rest_.resize(kLongestLine);  // long enough to be invalid when it ends
      }
    } catch (const InputError&) {
      if (rows_.empty()) throw;
      keep_taken();
      error_ = std::current_exception();
      break;
    }
  }
  return rows_;
}

bool write_bytes(int file, std::string_view bytes) {
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t n = ::write(file, bytes.data() + written, bytes.size() - written);
    if (n >= 0) {
      written += static_cast<std::size_t>(n);
    } else if (errno == EPIPE) {
      return false;
    } else if (errno != EINTR) {
      throw InputError(fmt::format("standard output: {}", std::strerror(errno)));
    }
  }
  return true;
}

bool write_rows(int file, std::span<const Lines> rows, bool with_index) {
  constexpr std::array<char, 2> kBit = {'0', '1'};
  std::string text;
  text.resize(rows.size() * (with_index ? 6 : 4));
  char* c = text.data();
  for (Lines row : rows) {
    *c++ = kBit[row & 1];
    *c++ = ' ';
    *c++ = kBit[row >> 1 & 1];
    if (with_index) {
      *c++ = ' ';
      *c++ = kBit[row >> 2 & 1];
    }
    *c++ = '\n';
  }
  return write_bytes(file, text);
}

}  // namespace driftwright::compensation
