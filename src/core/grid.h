// A width × height array in row-major order, row 0 on top.
#pragma once

#include <cstddef>
#include <vector>

namespace hemibake {

template <class T>
struct Grid {
  int width = 0;
  int height = 0;
  std::vector<T> values;

  Grid() = default;
  Grid(int w, int h, T value = T{})
      : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}

  size_t size() const { return values.size(); }
  bool empty() const { return values.empty(); }
  size_t index(int x, int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width) + x; }

  T& operator()(int x, int y) { return values[index(x, y)]; }
  const T& operator()(int x, int y) const { return values[index(x, y)]; }
  T& operator[](size_t i) { return values[i]; }
  const T& operator[](size_t i) const { return values[i]; }
};

// i modulo n in 0..n-1, also for negative i.
inline int wrap_index(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

}  // namespace hemibake
