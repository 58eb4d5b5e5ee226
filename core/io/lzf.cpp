#include "core/io/lzf.hpp"

#include <algorithm>

namespace hulltrack {

bool lzf_decompress(std::span<const std::uint8_t> in, std::span<std::uint8_t> out) {
  std::size_t i = 0;
  std::size_t o = 0;
  while (i < in.size()) {
    const std::size_t control = in[i++];
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > in.size() - i || count > out.size() - o) {
        return false;
      }
      std::copy_n(in.begin() + static_cast<std::ptrdiff_t>(i), count,
                  out.begin() + static_cast<std::ptrdiff_t>(o));
      i += count;
      o += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7) {
      if (i == in.size()) {
        return false;
      }
      count += in[i++];
    }
    count += 2;
    if (i == in.size()) {
      return false;
    }
    const std::size_t distance = ((control & 31) << 8 | in[i++]) + 1;
    if (distance > o || count > out.size() - o) {
      return false;
    }
    for (; count > 0; --count, ++o) {  // byte by byte: the copy may overlap its source
      out[o] = out[o - distance];
    }
  }
  return o == out.size();
}

}  // namespace hulltrack
