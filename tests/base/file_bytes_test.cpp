// Whole files as bytes: what is no file, and what has no end.

#include "base/file_bytes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/errors.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::file_bytes_test {
namespace {

TEST(FileBytes, ComeBackAsTheyWereWritten) {
  const std::string bytes("a\0\r\n\xFF", 5);
  const auto path = temporary_folder() / "bytes";
  write_bytes(path, bytes);
  EXPECT_EQ(read_bytes(path), bytes);
  EXPECT_EQ(read_bytes("/dev/null"), "");
}

TEST(FileBytes, OfADeviceWithoutEndAreRefusedBeforeMemoryIsFull) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &before), 0);
  rlimit little = before;  // a second of /dev/zero is more
  little.rlim_cur = rlim_t(512) << 20;
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &little), 0);
  for (const char* device : {"/dev/zero", "/dev/urandom", "/dev/full"})
    EXPECT_REFUSED(read_bytes(device), "without end") << device;
  setrlimit(RLIMIT_DATA, &before);
}

}  // namespace
}  // namespace driftwright::file_bytes_test
