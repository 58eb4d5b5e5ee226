// Livox datagrams written by hand, independent of the encoder and of the decoder's tables.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace hulltrack::test {

class LivoxBytes {
 public:
  /// Generation 2: `records` of `record_bytes`, all zero; 475.0 us from first to last, stamped 7 s.
  static LivoxBytes second(std::uint8_t type, std::size_t record_bytes, std::size_t records) {
    LivoxBytes d(36, record_bytes, records);
    d.put(1, d.bytes.size(), 2);
    d.put(3, 4750, 2);
    d.put(5, records, 2);
    d.put(7, 41, 2);
    d.put(10, type, 1);
    d.put(28, 7'000'000'000, 8);
    return d;
  }
  /// Generation 1, stamped 7 s since power-on.
  static LivoxBytes first(std::uint8_t type, std::size_t record_bytes, std::size_t records) {
    LivoxBytes d(18, record_bytes, records);
    d.put(0, 5, 1);
    d.put(9, type, 1);
    d.put(10, 7'000'000'000, 8);
    return d;
  }

  struct Field {
    std::int64_t value;
    int size;  // bytes
  };
  /// Fills a record from its first byte on.
  void record(std::size_t index, std::initializer_list<Field> fields) {
    std::size_t at = header_ + index * record_bytes_;
    for (const Field& field : fields) {
      put(at, static_cast<std::uint64_t>(field.value), field.size);
      at += static_cast<std::size_t>(field.size);
    }
  }
  void put(std::size_t at, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i)
      bytes.at(at + static_cast<std::size_t>(i)) = static_cast<std::uint8_t>(value >> (8 * i));
  }

  std::vector<std::uint8_t> bytes;

 private:
  LivoxBytes(std::size_t header, std::size_t record_bytes, std::size_t records)
      : bytes(header + record_bytes * records), header_(header), record_bytes_(record_bytes) {}

  std::size_t header_;
  std::size_t record_bytes_;
};

}  // namespace hulltrack::test
