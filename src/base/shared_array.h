// An immutable array shared by any number of users: a finished vector, or part of a mapped file.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tyndall {
template<class T> class SharedArray {
public:
    SharedArray() = default;
    SharedArray(std::vector<T> elements) {
        const auto owner = std::make_shared<const std::vector<T>>(std::move(elements));
        elements_ = *owner, owner_ = owner;
    }
    // Elements kept alive by `owner`.
    SharedArray(std::span<const T> elements, std::shared_ptr<const void> owner)
        : elements_(elements), owner_(std::move(owner)) {}

    const T* data() const { return elements_.data(); }
    size_t size() const { return elements_.size(); }
    bool empty() const { return elements_.empty(); }
    const T& operator[](size_t i) const { return elements_[i]; }
    auto begin() const { return elements_.begin(); }
    auto end() const { return elements_.end(); }
    bool operator==(const SharedArray& other) const { return std::ranges::equal(*this, other); }

private:
    std::span<const T> elements_;
    std::shared_ptr<const void> owner_;
};
}
