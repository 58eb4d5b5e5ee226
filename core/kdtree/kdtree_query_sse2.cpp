// The kd-tree's searches with SSE2, which every x86-64 processor has: eight floats in two registers.
#include <emmintrin.h>

#include "core/kdtree/kdtree_query.hpp"

namespace hulltrack::kdtree {
namespace sse2 {

#define HULLTRACK_TARGET

struct Lanes {
  __m128 low, high;
};

inline Lanes load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
inline void store(float* p, Lanes a) {
  _mm_store_ps(p, a.low);
  _mm_store_ps(p + 4, a.high);
}
inline Lanes broadcast(float a) { return {_mm_set1_ps(a), _mm_set1_ps(a)}; }
inline Lanes zero() { return {_mm_setzero_ps(), _mm_setzero_ps()}; }
inline Lanes add(Lanes a, Lanes b) { return {_mm_add_ps(a.low, b.low), _mm_add_ps(a.high, b.high)}; }
inline Lanes sub(Lanes a, Lanes b) { return {_mm_sub_ps(a.low, b.low), _mm_sub_ps(a.high, b.high)}; }
inline Lanes mul(Lanes a, Lanes b) { return {_mm_mul_ps(a.low, b.low), _mm_mul_ps(a.high, b.high)}; }
inline Lanes min(Lanes a, Lanes b) { return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)}; }
inline Lanes max(Lanes a, Lanes b) { return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)}; }
inline std::uint32_t at_most(Lanes a, Lanes b) {
  const int low = _mm_movemask_ps(_mm_cmple_ps(a.low, b.low));
  const int high = _mm_movemask_ps(_mm_cmple_ps(a.high, b.high));
  return static_cast<std::uint32_t>(low | (high << 4));
}
inline float smallest(Lanes a) {
  __m128 m = _mm_min_ps(a.low, a.high);
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_shuffle_ps(m, m, 1)));
}

#include "core/kdtree/kdtree_query_body.hpp"

}  // namespace sse2

const Kernels& sse2_kernels() {
  static constexpr Kernels kernels{"SSE2", sse2::nearest, sse2::neighbourhoods, sse2::nearest_k,
                                   sse2::within};
  return kernels;
}

}  // namespace hulltrack::kdtree
