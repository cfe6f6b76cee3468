/* Stubs of the few things of Unreal that docs/engines.md names, in the place of the engine. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

using int64 = std::int64_t;

#define TEXT(words) words
#define UTF8_TO_TCHAR(words) words
#define UE_LOG(category, level, ...) static_cast<void>(0)

struct FVector {
    static const FVector UpVector;
    FVector(double, double, double) {}
};
struct FQuat {
    FQuat(const FVector &, double) {}
};
struct FTransform {
    FTransform(const FQuat &, const FVector &) {}
};
template <typename T> struct TArray {
    std::vector<T> items;
    void SetNumUninitialized(std::size_t count) { items.resize(count); }
    T *GetData() { return items.data(); }
    T &operator[](std::size_t i) { return items[i]; }
    template <typename... A> void Emplace(A &&...a) { items.emplace_back(a...); }
};
struct UHierarchicalInstancedStaticMeshComponent {
    void AddInstances(const TArray<FTransform> &, bool, bool) {}
};
