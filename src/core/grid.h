// A width × height array in row-major order, row 0 on top.
#pragma once

#include <cmath>
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

// Returns i modulo n in 0..n-1, also for negative i.
inline int wrap_index(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

// Returns at(column, row) interpolated bilinearly at (x, y), samples at whole numbers; weights are of type T.
template <class T, class At>
auto interpolate_bilinear(double x, double y, const At& at) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const T u = static_cast<T>(x - i), v = static_cast<T>(y - j);
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

}  // namespace hemibake
