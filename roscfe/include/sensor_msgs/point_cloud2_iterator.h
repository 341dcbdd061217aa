// Points of a sensor_msgs/PointCloud2, field by field (http://docs.ros.org/api/sensor_msgs/html).
#ifndef ROSCFE_SENSOR_MSGS_POINT_CLOUD2_ITERATOR_H
#define ROSCFE_SENSOR_MSGS_POINT_CLOUD2_ITERATOR_H

#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "roscfe/refuse.h"
#include "sensor_msgs/PointCloud2.h"

namespace sensor_msgs
{

// Bytes of a type of PointField.
inline int sizeOfPointField(int datatype)
{
    switch (datatype)
    {
        case PointField::INT8:
        case PointField::UINT8:
            return 1;
        case PointField::INT16:
        case PointField::UINT16:
            return 2;
        case PointField::INT32:
        case PointField::UINT32:
        case PointField::FLOAT32:
            return 4;
        case PointField::FLOAT64:
            return 8;
        default:
            ROSCFE_THROW(std::runtime_error("PointField of type " + std::to_string(datatype) + " does not exist"));
    }
}

// Adds a field at an offset of a point; the offset behind it.
inline int addPointField(PointCloud2 &cloud, const std::string &name, int count, int datatype, int offset)
{
    cloud.fields.emplace_back();
    PointField &field = cloud.fields.back();
    field.name        = name.c_str();
    field.count       = static_cast<std::uint32_t>(count);
    field.datatype    = static_cast<std::uint8_t>(datatype);
    field.offset      = static_cast<std::uint32_t>(offset);
    cloud.point_step  = static_cast<std::uint32_t>(offset + count * sizeOfPointField(datatype));
    return static_cast<int>(cloud.point_step);
}

class PointCloud2Modifier
{
  public:
    explicit PointCloud2Modifier(PointCloud2 &cloud) : cloud_(cloud) {}

    std::size_t size() const { return cloud_.point_step == 0 ? 0 : cloud_.data.size() / cloud_.point_step; }
    void        reserve(std::size_t size) { cloud_.data.reserve(size * cloud_.point_step); }
    void        resize(std::size_t size)
    {
        cloud_.data.resize(size * cloud_.point_step);
        if (cloud_.height != 1)
        {
            cloud_.height = 1; // no longer organized
        }
        cloud_.width    = static_cast<std::uint32_t>(size);
        cloud_.row_step = static_cast<std::uint32_t>(cloud_.width * cloud_.point_step);
    }
    void clear()
    {
        cloud_.data.clear();
        cloud_.height = 1;
        cloud_.row_step = cloud_.width = 0;
    }

    // For each field its name, how many, and the type: ("x", 1, sensor_msgs::PointField::FLOAT32, ...).
    void setPointCloud2Fields(int count, ...)
    {
        cloud_.fields.clear();
        std::va_list arguments;
        va_start(arguments, count);
        int offset = 0;
        for (int i = 0; i < count; ++i)
        {
            const std::string name(va_arg(arguments, char *));
            const int         many     = va_arg(arguments, int);
            const int         datatype = va_arg(arguments, int);
            offset                     = addPointField(cloud_, name, many, datatype, offset);
        }
        va_end(arguments);
        finish(offset);
    }

    // "xyz", "rgb" and "rgba", padded as PCL has them.
    void setPointCloud2FieldsByString(int count, ...)
    {
        cloud_.fields.clear();
        std::va_list arguments;
        va_start(arguments, count);
        int offset = 0;
        for (int i = 0; i < count; ++i)
        {
            const std::string name(va_arg(arguments, char *));
            if (name == "xyz")
            {
                for (const char *each : {"x", "y", "z"})
                {
                    offset = addPointField(cloud_, each, 1, PointField::FLOAT32, offset);
                }
                offset += sizeOfPointField(PointField::FLOAT32);
            }
            else if (name == "rgb" || name == "rgba")
            {
                offset = addPointField(cloud_, name, 1, PointField::FLOAT32, offset);
                offset += 3 * sizeOfPointField(PointField::FLOAT32);
            }
            else
            {
                va_end(arguments);
                ROSCFE_THROW(std::runtime_error("Field " + name + " does not exist"));
            }
        }
        va_end(arguments);
        finish(offset);
    }

  private:
    void finish(int offset)
    {
        cloud_.point_step = static_cast<std::uint32_t>(offset);
        cloud_.row_step   = cloud_.width * cloud_.point_step;
        cloud_.data.resize(static_cast<std::size_t>(cloud_.height) * cloud_.row_step);
    }

    PointCloud2 &cloud_;
};

namespace impl
{

// Self is the iterator that is derived; T is a field's type, const for clouds that are only read; Byte is the type of the
// cloud's bytes.
template <class Self, class T, class Byte, class Cloud>
class PointCloud2IteratorBase
{
  public:
    PointCloud2IteratorBase() = default;
    PointCloud2IteratorBase(Cloud &cloud, const std::string &name)
    {
        const int offset = offset_of(cloud, name);
        step_            = cloud.point_step;
        is_bigendian_    = cloud.is_bigendian != 0;
        Byte *begin      = cloud.data.size() > 0 ? &cloud.data[0] : nullptr;
        end_             = begin + cloud.data.size() + (cloud.data.size() > 0 ? offset : 0);
        at_              = begin + (cloud.data.size() > 0 ? offset : 0);
    }

    T &operator[](std::size_t i) const { return reinterpret_cast<T *>(at_)[i]; }
    T &operator*() const { return *reinterpret_cast<T *>(at_); }

    Self &operator++()
    {
        at_ += step_;
        return own();
    }
    Self operator+(int count) const
    {
        Self moved = own();
        moved += count;
        return moved;
    }
    Self &operator+=(int count)
    {
        at_ += static_cast<std::ptrdiff_t>(step_) * count;
        return own();
    }
    bool operator!=(const Self &other) const { return at_ != other.at_; }

    Self end() const
    {
        Self last = own();
        last.at_  = end_;
        return last;
    }

  private:
    Self &      own() { return static_cast<Self &>(*this); }
    const Self &own() const { return static_cast<const Self &>(*this); }

    // Where a field is in a point. The parts of "rgb" and "rgba" have names of their own.
    int offset_of(const Cloud &cloud, const std::string &name) const
    {
        for (const PointField &each : cloud.fields)
        {
            if (each.name == name.c_str())
            {
                return static_cast<int>(each.offset);
            }
        }
        static const std::string kLittle = "bgra", kBig = "argb";
        for (const PointField &each : cloud.fields)
        {
            const bool        has_parts = each.name == "rgb" || each.name == "rgba";
            const std::size_t part      = (cloud.is_bigendian != 0 ? kBig : kLittle).find(name);
            if (has_parts && name.size() == 1 && part != std::string::npos)
            {
                return static_cast<int>(each.offset + part);
            }
        }
        ROSCFE_THROW(std::runtime_error("Field " + name + " does not exist"));
    }

    std::uint32_t step_         = 0;
    bool          is_bigendian_ = false;
    Byte *        at_           = nullptr;
    Byte *        end_          = nullptr;
};

} // namespace impl

template <class T>
class PointCloud2Iterator
    : public impl::PointCloud2IteratorBase<PointCloud2Iterator<T>, T, unsigned char, PointCloud2>
{
  public:
    typedef impl::PointCloud2IteratorBase<PointCloud2Iterator<T>, T, unsigned char, PointCloud2> Base;
    PointCloud2Iterator(PointCloud2 &cloud, const std::string &name) : Base(cloud, name) {}
};

template <class T>
class PointCloud2ConstIterator
    : public impl::PointCloud2IteratorBase<PointCloud2ConstIterator<T>, const T, const unsigned char, const PointCloud2>
{
  public:
    typedef impl::PointCloud2IteratorBase<PointCloud2ConstIterator<T>, const T, const unsigned char, const PointCloud2> Base;
    PointCloud2ConstIterator(const PointCloud2 &cloud, const std::string &name) : Base(cloud, name) {}
};

} // namespace sensor_msgs

#endif
