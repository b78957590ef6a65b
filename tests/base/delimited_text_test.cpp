// Text files in encodings of loggers.

#include "base/delimited_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iconv.h>

#include <fstream>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::delimited_text_test {
namespace {

/// What glibc makes of one byte of Windows-1252; "" if the encoding lacks it.
std::string by_glibc(char byte) {
  const iconv_t converter = iconv_open("UTF-8", "WINDOWS-1252");
  std::string text(8, '\0');
  char *in = &byte, *out = text.data();
  std::size_t n_in = 1, n_out = text.size();
  const std::size_t failed = iconv(converter, &in, &n_in, &out, &n_out);
  iconv_close(converter);
  text.resize(failed == static_cast<std::size_t>(-1) ? 0 : text.size() - n_out);
  return text;
}

TEST(TextFile, InWindows1252IsWhatGlibcMakesOfEachByte) {
  int n_lacking = 0;
  for (int byte = 0x80; byte <= 0xFF; ++byte) {
    const std::string wanted = by_glibc(static_cast<char>(byte)), bytes = {'a', static_cast<char>(byte), 'b'};
    if (wanted.empty()) {
      ++n_lacking;
      EXPECT_REFUSED(read_text_file(write_file("lacking.csv", bytes)), "byte 2 is no text in WINDOWS-1252") << byte;
    } else {
      EXPECT_EQ(read_text_file(write_file("text.csv", bytes)), "a" + wanted + "b") << byte;
    }
  }
  EXPECT_EQ(n_lacking, 5);
}

}  // namespace
}  // namespace driftwright::delimited_text_test
