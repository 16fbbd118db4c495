// An array that its copies share. Who holds the same array as before need not compare, copy or upload it again.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace glim {

template <class T>
class SharedVector {
public:
    using value_type = T;

    // An array as it was, which it does not keep alive.
    class Identity {
    public:
        Identity() = default;
        explicit Identity(const SharedVector& array)
            : values_(array.values_)
        {}
        bool is(const SharedVector& array) const { return values_.lock() == array.values_; }

    private:
        std::weak_ptr<const std::vector<T>> values_;
    };

    SharedVector() = default;
    SharedVector(std::vector<T> values)
        : values_(std::make_shared<std::vector<T>>(std::move(values)))
    {}

    // The values, to be changed: from here on this is another array. Copied if somebody else holds them.
    std::vector<T>& change()
    {
        values_ =
            values_.use_count() > 1 ? std::make_shared<std::vector<T>>(*values_) : std::make_shared<std::vector<T>>(std::move(*values_));
        return *values_;
    }

    bool isSameAs(const SharedVector& other) const { return values_ == other.values_; }

    std::size_t size() const { return values_->size(); }
    bool empty() const { return values_->empty(); }
    const T* data() const { return values_->data(); }
    const T& operator[](std::size_t i) const { return (*values_)[i]; }
    const T& at(std::size_t i) const { return values_->at(i); }
    const T& front() const { return values_->front(); }
    const T& back() const { return values_->back(); }
    auto begin() const { return std::as_const(*values_).begin(); }
    auto end() const { return std::as_const(*values_).end(); }
    operator const std::vector<T>&() const { return *values_; }
    bool operator==(const SharedVector& other) const { return values_ == other.values_ || *values_ == *other.values_; }

private:
    std::shared_ptr<std::vector<T>> values_ = std::make_shared<std::vector<T>>();
};

}  // namespace glim
