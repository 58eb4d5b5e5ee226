// A sealed file in memory: the same bytes for everybody, for ever.
#include "daemon/service/memory_file.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "tests/support/temp_folder.hpp"

namespace hulltrack {
namespace {

TEST(MemoryFile, OpensByItsPathWithTheBytesThatWereWritten) {
  const std::string bytes("one\0two\n", 8);
  const MemoryFile file("test", bytes);
  EXPECT_EQ(test::read_text(file.path()), bytes);
  EXPECT_EQ(test::read_text(file.path()), bytes) << "from the beginning each time";
  EXPECT_EQ(MappedBytes(file).bytes(), bytes);
}

TEST(MemoryFile, CanNoLongerChangeOnceItIsSealed) {
  MemoryFile file("test");
  write_all(file.fd(), "abc");
  const int other = dup(file.fd());
  file.seal();
  EXPECT_THROW(write_all(other, "d"), std::system_error);
  EXPECT_NE(ftruncate(other, 0), 0);
  EXPECT_NE(ftruncate(other, 100), 0);
  close(other);
  EXPECT_EQ(MappedBytes(file).bytes(), "abc");
}

/// Somebody who may write to it.
class Writer {
 public:
  explicit Writer(const MemoryFile& file)
      : begin_(mmap(nullptr, 3, PROT_READ | PROT_WRITE, MAP_SHARED, file.fd(), 0)) {}
  ~Writer() { munmap(begin_, 3); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

 private:
  void* begin_;
};

TEST(MemoryFile, IsSealedOnceNobodyWritesToItAnyMore) {
  MemoryFile file("test");
  write_all(file.fd(), "abc");
  auto writer = std::make_unique<Writer>(file);
  std::thread leaves([&writer] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    writer.reset();
  });
  file.seal();
  leaves.join();
  EXPECT_EQ(MappedBytes(file).bytes(), "abc");
}

TEST(MemoryFile, IsNotSealedWhileSomebodyMayWriteToIt) {
  MemoryFile file("test");
  write_all(file.fd(), "abc");
  const Writer stays(file);
  EXPECT_THROW(file.seal(), std::system_error);
}

TEST(MemoryFile, IsNotLookedIntoBeforeItIsSealed) {
  MemoryFile file("test");
  write_all(file.fd(), "abc");
  EXPECT_THROW(MappedBytes{file}, std::invalid_argument);
}

TEST(MemoryFile, MayBeEmpty) { EXPECT_TRUE(MappedBytes(MemoryFile("test", "")).bytes().empty()); }

TEST(MemoryFile, ClosesWhatItHoldsOnce) {
  MemoryFile first("test", "a");
  const int fd = first.fd();
  MemoryFile second = std::move(first);
  EXPECT_EQ(second.fd(), fd);
  EXPECT_EQ(MappedBytes(second).bytes(), "a");
}

}  // namespace
}  // namespace hulltrack
