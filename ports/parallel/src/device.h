// Memory and loops of the machine that computes the solvent: a GPU where nvcc compiles this, else all cores by OpenMP.
// A loop's body has no order: bodies of one loop write to places of their own, or add whole numbers.
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <sys/mman.h>

#include "arithmetic.h"

#ifdef _OPENMP
#include <omp.h>
#endif

constexpr int block_size = 256;

#ifdef __CUDACC__
#define BODY __device__
constexpr bool on_gpu = true;

inline void device_check(cudaError_t error, const char *what)
{
  if (error != cudaSuccess) {
    std::fprintf(stderr, "port: %s: %s\n", what, cudaGetErrorString(error));
    std::exit(1);
  }
}

template <class Body> __global__ void __launch_bounds__(block_size) device_loop(int64_t n, Body body)
{
  const int64_t i = (int64_t)blockIdx.x * block_size + threadIdx.x;
  if (i < n)
    body(i, 0);
}

inline void device_wait()
{
  device_check(cudaDeviceSynchronize(), "a kernel");
}

template <class Body> void for_each(int64_t n, Body body)
{
  if (n == 0)
    return;
  device_loop<<<(unsigned)((n + block_size - 1) / block_size), block_size>>>(n, body);
  device_check(cudaGetLastError(), "launch of a kernel");
}

// Copies of a sum that threads add to: on a GPU one, by atomic additions of integers.
inline int shard_count()
{
  return 1;
}

__device__ inline void add_whole(int64_t *to, int64_t number)
{
  atomicAdd((unsigned long long *)to, (unsigned long long)number);
}

// Copies of a sum that all threads add to: by blocks, so that few wait for each other.
constexpr int total_copies = 64;
inline int total_shards()
{
  return total_copies;
}
__device__ inline int total_shard(int)
{
  return (int)(blockIdx.x % total_copies);
}

// All threads of a warp add to one place: their numbers are summed first. In whole numbers the order changes nothing.
__device__ inline void add_together(int64_t *to, int64_t number)
{
#ifdef __CUDA_ARCH__
  if (__activemask() == 0xffffffffu) {
    for (int far = 16; far > 0; far /= 2)
      number += __shfl_xor_sync(0xffffffffu, (long long)number, far);
    if ((threadIdx.x & 31) == 0)
      add_whole(to, number);
    return;
  }
#endif
  add_whole(to, number);
}

__device__ inline int64_t fetch_add_whole(int64_t *to, int64_t number)
{
  return (int64_t)atomicAdd((unsigned long long *)to, (unsigned long long)number);
}
#else
#define BODY
constexpr bool on_gpu = false;

inline void device_wait()
{
}

// The loop over blocks, and over the threads of a block. `shard` is the number of the thread of the host.
template <class Body> void for_each(int64_t n, Body body)
{
  const int64_t blocks = (n + block_size - 1) / block_size;
#pragma omp parallel
  {
#ifdef _OPENMP
    const int shard = omp_get_thread_num();
#else
    const int shard = 0;
#endif
#pragma omp for schedule(static)
    for (int64_t block = 0; block < blocks; block++) {
      const int64_t first = block * block_size, last = first + block_size < n ? first + block_size : n;
      for (int64_t i = first; i < last; i++)
        body(i, shard);
    }
  }
}

// The same, of bodies that are long.
template <class Body> void for_each_block(int64_t n, Body body)
{
#pragma omp parallel
  {
#ifdef _OPENMP
    const int shard = omp_get_thread_num();
#else
    const int shard = 0;
#endif
#pragma omp for schedule(static)
    for (int64_t i = 0; i < n; i++)
      body(i, shard);
  }
}

// Large pages for what is large: members of a cell are looked up all over the arrays. Arrays begin at unlike places
// within pages, so that one particle's columns do not take each other's place in the nearest cache.
constexpr size_t large_page = (size_t)1 << 21;

inline void *take_memory(size_t bytes)
{
  const bool large = bytes >= large_page / 4;
  static size_t taken = 0;
  const size_t begin = large ? (taken++ % 13) * 73 * 64 : 0, unit = large ? large_page : 64;
  const size_t whole = (bytes + begin + unit - 1) / unit * unit;
  char *const memory = (char *)std::aligned_alloc(unit, whole);
  if (!memory)
    throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (large)
    (void)madvise(memory, whole, MADV_HUGEPAGE); // a wish
#endif
  return memory + begin;
}

inline void give_memory(void *memory, size_t bytes)
{
  const size_t unit = bytes >= large_page / 4 ? large_page : 64;
  std::free((void *)((uintptr_t)memory / unit * unit));
}

// On the host a copy of the sum for each thread.
inline int shard_count()
{
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

inline int total_shards()
{
  return shard_count();
}
inline int total_shard(int shard)
{
  return shard;
}

inline void add_whole(int64_t *to, int64_t number)
{
  *to += number;
}
inline void add_together(int64_t *to, int64_t number)
{
  *to += number;
}
inline int64_t fetch_add_whole(int64_t *to, int64_t number)
{
  return __atomic_fetch_add(to, number, __ATOMIC_RELAXED);
}
#endif

// Memory of the machine that computes.
template <class T> class Array
{
public:
  Array() = default;
  explicit Array(size_t n)
  {
    resize(n);
  }
  ~Array()
  {
    free_all();
  }
  Array(const Array &) = delete;
  Array &operator=(const Array &) = delete;

  // Contents are lost.
  void resize(size_t n)
  {
    free_all();
    count = n;
    if (n == 0)
      return;
#ifdef __CUDACC__
    device_check(cudaMalloc((void **)&at, n * sizeof(T)), "memory of the GPU");
#else
    at = (T *)take_memory(n * sizeof(T));
#endif
  }

  void swap(Array &other)
  {
    std::swap(at, other.at);
    std::swap(count, other.count);
  }

  void clear()
  {
#ifdef __CUDACC__
    if (count > 0)
      device_check(cudaMemset(at, 0, count * sizeof(T)), "clearing memory");
#else
    T *const to = at;
    for_each((int64_t)count, [=](int64_t i, int) { to[i] = T{}; });
#endif
  }

  void upload(const T *from, size_t n)
  {
#ifdef __CUDACC__
    device_check(cudaMemcpy(at, from, n * sizeof(T), cudaMemcpyHostToDevice), "copy to the GPU");
#else
    std::memcpy((void *)at, from, n * sizeof(T));
#endif
  }

  void download(T *to, size_t n) const
  {
#ifdef __CUDACC__
    device_check(cudaMemcpy(to, at, n * sizeof(T), cudaMemcpyDeviceToHost), "copy from the GPU");
#else
    std::memcpy((void *)to, at, n * sizeof(T));
#endif
  }

  T *data() const
  {
    return at;
  }
  size_t size() const
  {
    return count;
  }

private:
  void free_all()
  {
#ifdef __CUDACC__
    cudaFree(at);
#else
    give_memory(at, count * sizeof(T));
#endif
    at = nullptr;
    count = 0;
  }

  T *at = nullptr;
  size_t count = 0;
};
