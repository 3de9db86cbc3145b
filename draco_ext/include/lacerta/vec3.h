// Three coordinates with the arithmetic that the codec needs.
#ifndef LACERTA_VEC3_H_
#define LACERTA_VEC3_H_

#include <cmath>

namespace lacerta {

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  Vec3& operator-=(const Vec3& b) { return *this = {x - b.x, y - b.y, z - b.z}; }
  Vec3& operator*=(T s) { return *this = {x * s, y * s, z * s}; }
  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator*(T s, const Vec3& a) { return {a.x * s, a.y * s, a.z * s}; }
  friend bool operator==(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
  friend bool operator!=(const Vec3& a, const Vec3& b) { return !(a == b); }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <typename T>
T Dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
Vec3<T> Cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
T SquaredNorm(const Vec3<T>& a) {
  return Dot(a, a);
}

template <typename T>
T Norm(const Vec3<T>& a) {
  return std::sqrt(Dot(a, a));
}

template <typename To, typename From>
Vec3<To> Vec3Cast(const Vec3<From>& a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

// a / |a|, or the zero vector where |a| is zero or not finite. In double, so that squares of tiny area vectors do not vanish.
template <typename T>
Vec3<T> Normalized(const Vec3<T>& a) {
  const Vec3d b = Vec3Cast<double>(a);
  const double norm = Norm(b);
  return norm > 0.0 && std::isfinite(norm) ? Vec3Cast<T>(b * (1.0 / norm)) : Vec3<T>{};
}

}  // namespace lacerta

#endif  // LACERTA_VEC3_H_
