#include "daemon/service/memory_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace hulltrack {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

MemoryFile::MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (fd_ < 0) {
    fail("cannot make a file in memory");
  }
}

MemoryFile::MemoryFile(const char* name, std::string_view bytes) : MemoryFile(name) {
  write_all(fd_, bytes);
  seal();
}

MemoryFile::~MemoryFile() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

MemoryFile& MemoryFile::operator=(MemoryFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

std::filesystem::path MemoryFile::path() const { return "/proc/self/fd/" + std::to_string(fd_); }

bool MemoryFile::try_seal() {
  const bool sealed = fcntl(fd_, F_ADD_SEALS, kSeals) == 0;
  if (!sealed && errno != EBUSY) {
    fail("cannot seal a file in memory");
  }
  return sealed;
}

void MemoryFile::seal() {
  const auto give_up = std::chrono::steady_clock::now() + kLongestBusy;
  while (!try_seal()) {
    if (std::chrono::steady_clock::now() > give_up) {
      throw std::system_error(EBUSY, std::generic_category(), "cannot seal a file in memory");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      fail("cannot write to a file in memory");
    }
    bytes.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
  }
}

MappedBytes::MappedBytes(const MemoryFile& file) {
  if ((fcntl(file.fd(), F_GET_SEALS) & kSeals) != kSeals) {
    throw std::invalid_argument("a file in memory is not sealed");
  }
  struct stat status {};
  if (fstat(file.fd(), &status) != 0) {
    fail("cannot look at a file in memory");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) {
    return;
  }
  void* const begin = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.fd(), 0);
  if (begin == MAP_FAILED) {
    fail("cannot map a file in memory");
  }
  begin_ = begin;
}

MappedBytes::~MappedBytes() {
  if (begin_ != nullptr) {
    munmap(begin_, size_);
  }
}

std::string_view MappedBytes::bytes() const { return {static_cast<const char*>(begin_), size_}; }

}  // namespace hulltrack
