// The kd-tree's searches with AVX2: eight floats a register.
#include <immintrin.h>

#include "core/kdtree/kdtree_query.hpp"

namespace hulltrack::kdtree {
namespace avx2 {

#define HULLTRACK_TARGET __attribute__((target("avx2")))

struct Lanes {
  __m256 v;
};

HULLTRACK_TARGET inline Lanes load(const float* p) { return {_mm256_load_ps(p)}; }
HULLTRACK_TARGET inline void store(float* p, Lanes a) { _mm256_store_ps(p, a.v); }
HULLTRACK_TARGET inline Lanes broadcast(float a) { return {_mm256_set1_ps(a)}; }
HULLTRACK_TARGET inline Lanes zero() { return {_mm256_setzero_ps()}; }
HULLTRACK_TARGET inline Lanes add(Lanes a, Lanes b) { return {_mm256_add_ps(a.v, b.v)}; }
HULLTRACK_TARGET inline Lanes sub(Lanes a, Lanes b) { return {_mm256_sub_ps(a.v, b.v)}; }
HULLTRACK_TARGET inline Lanes mul(Lanes a, Lanes b) { return {_mm256_mul_ps(a.v, b.v)}; }
HULLTRACK_TARGET inline Lanes min(Lanes a, Lanes b) { return {_mm256_min_ps(a.v, b.v)}; }
HULLTRACK_TARGET inline Lanes max(Lanes a, Lanes b) { return {_mm256_max_ps(a.v, b.v)}; }
HULLTRACK_TARGET inline std::uint32_t at_most(Lanes a, Lanes b) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)));
}
HULLTRACK_TARGET inline float smallest(Lanes a) {
  __m128 m = _mm_min_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  m = _mm_min_ps(m, _mm_movehl_ps(m, m));
  return _mm_cvtss_f32(_mm_min_ss(m, _mm_shuffle_ps(m, m, 1)));
}

#include "core/kdtree/kdtree_query_body.hpp"

}  // namespace avx2

const Kernels& avx2_kernels() {
  static constexpr Kernels kernels{"AVX2", avx2::nearest, avx2::neighbourhoods, avx2::nearest_k,
                                   avx2::within};
  return kernels;
}

bool avx2_available() { return __builtin_cpu_supports("avx2") != 0; }

}  // namespace hulltrack::kdtree
