// A file that lies in memory only and that nobody can change once it is sealed (memfd_create(2)).
//
// What a process has read of a file stays what it has read, whoever writes to that file meanwhile, and can be
// handed to another process or opened by path once more. Its pages count as this service's memory.
// Failure: std::system_error with what could not be done. Thread rule: a plain value, moved but not copied.
// Cost: a copy of the bytes.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string_view>

namespace hulltrack {

class MemoryFile {
 public:
  /// Empty, to be written and then sealed. `name` shows in /proc, nowhere else.
  explicit MemoryFile(const char* name);
  /// Holds `bytes` and is sealed.
  MemoryFile(const char* name, std::string_view bytes);
  ~MemoryFile();
  MemoryFile(MemoryFile&& other) noexcept;
  MemoryFile& operator=(MemoryFile&& other) noexcept;
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  /// Opens it for reading in this process, as long as this object lives.
  [[nodiscard]] std::filesystem::path path() const;

  /// From now on neither content nor size can change, through whatever descriptor. Throws when somebody may
  /// still write to it: after kLongestBusy, since the kernel itself may hold a page of a write a moment ago.
  /// It waits 150 ms for that to end (EBUSY in fcntl(2)), which on a busy computer has been too short.
  void seal();
  /// The same for who has no time to wait: false while somebody may still write to it, after 150 ms at most.
  [[nodiscard]] bool try_seal();
  static constexpr std::chrono::seconds kLongestBusy{2};

 private:
  int fd_;
};

/// Writes all of `bytes` at the descriptor's place.
void write_all(int fd, std::string_view bytes);

/// The bytes of a sealed memory file, readable while this object lives. Throws std::invalid_argument for one
/// that is not sealed, whose bytes could change or vanish under the reader's hands.
class MappedBytes {
 public:
  explicit MappedBytes(const MemoryFile& file);
  ~MappedBytes();
  MappedBytes(const MappedBytes&) = delete;
  MappedBytes& operator=(const MappedBytes&) = delete;

  [[nodiscard]] std::string_view bytes() const;

 private:
  void* begin_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace hulltrack
