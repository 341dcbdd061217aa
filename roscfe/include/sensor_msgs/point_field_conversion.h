// Values in the bytes of a point, by the types of sensor_msgs/PointField.
#ifndef ROSCFE_SENSOR_MSGS_POINT_FIELD_CONVERSION_H
#define ROSCFE_SENSOR_MSGS_POINT_FIELD_CONVERSION_H

#include <cstdint>
#include <cstring>

#include "sensor_msgs/PointField.h"

namespace sensor_msgs
{

template <int>
struct pointFieldTypeAsType
{
};
template <typename T>
struct typeAsPointFieldType
{
};

#define ROSCFE_POINT_FIELD(NAME, TYPE)                                                                                 \
    template <>                                                                                                        \
    struct pointFieldTypeAsType<PointField::NAME>                                                                      \
    {                                                                                                                  \
        typedef TYPE type;                                                                                             \
    };                                                                                                                 \
    template <>                                                                                                        \
    struct typeAsPointFieldType<TYPE>                                                                                  \
    {                                                                                                                  \
        static const std::uint8_t value = PointField::NAME;                                                            \
    };
ROSCFE_POINT_FIELD(INT8, std::int8_t)
ROSCFE_POINT_FIELD(UINT8, std::uint8_t)
ROSCFE_POINT_FIELD(INT16, std::int16_t)
ROSCFE_POINT_FIELD(UINT16, std::uint16_t)
ROSCFE_POINT_FIELD(INT32, std::int32_t)
ROSCFE_POINT_FIELD(UINT32, std::uint32_t)
ROSCFE_POINT_FIELD(FLOAT32, float)
ROSCFE_POINT_FIELD(FLOAT64, double)
#undef ROSCFE_POINT_FIELD

// Bytes of a point stand at any address.
template <int point_field_type, typename T>
inline T readPointCloud2BufferValue(const unsigned char *data_ptr)
{
    typename pointFieldTypeAsType<point_field_type>::type value;
    std::memcpy(&value, data_ptr, sizeof value);
    return static_cast<T>(value);
}

template <int point_field_type, typename T>
inline void writePointCloud2BufferValue(unsigned char *data_ptr, T value)
{
    const auto written = static_cast<typename pointFieldTypeAsType<point_field_type>::type>(value);
    std::memcpy(data_ptr, &written, sizeof written);
}

// A value of a type that is known at run time only; of one that there is not it is 0.
template <typename T>
inline T readPointCloud2BufferValue(const unsigned char *data_ptr, const unsigned char datatype)
{
    switch (datatype)
    {
        case PointField::INT8:
            return readPointCloud2BufferValue<PointField::INT8, T>(data_ptr);
        case PointField::UINT8:
            return readPointCloud2BufferValue<PointField::UINT8, T>(data_ptr);
        case PointField::INT16:
            return readPointCloud2BufferValue<PointField::INT16, T>(data_ptr);
        case PointField::UINT16:
            return readPointCloud2BufferValue<PointField::UINT16, T>(data_ptr);
        case PointField::INT32:
            return readPointCloud2BufferValue<PointField::INT32, T>(data_ptr);
        case PointField::UINT32:
            return readPointCloud2BufferValue<PointField::UINT32, T>(data_ptr);
        case PointField::FLOAT32:
            return readPointCloud2BufferValue<PointField::FLOAT32, T>(data_ptr);
        case PointField::FLOAT64:
            return readPointCloud2BufferValue<PointField::FLOAT64, T>(data_ptr);
        default:
            return T();
    }
}

// As above; of a type that there is not nothing is written.
template <typename T>
inline void writePointCloud2BufferValue(unsigned char *data_ptr, const unsigned char datatype, T value)
{
    switch (datatype)
    {
        case PointField::INT8:
            return writePointCloud2BufferValue<PointField::INT8, T>(data_ptr, value);
        case PointField::UINT8:
            return writePointCloud2BufferValue<PointField::UINT8, T>(data_ptr, value);
        case PointField::INT16:
            return writePointCloud2BufferValue<PointField::INT16, T>(data_ptr, value);
        case PointField::UINT16:
            return writePointCloud2BufferValue<PointField::UINT16, T>(data_ptr, value);
        case PointField::INT32:
            return writePointCloud2BufferValue<PointField::INT32, T>(data_ptr, value);
        case PointField::UINT32:
            return writePointCloud2BufferValue<PointField::UINT32, T>(data_ptr, value);
        case PointField::FLOAT32:
            return writePointCloud2BufferValue<PointField::FLOAT32, T>(data_ptr, value);
        case PointField::FLOAT64:
            return writePointCloud2BufferValue<PointField::FLOAT64, T>(data_ptr, value);
        default:
            return;
    }
}

} // namespace sensor_msgs

#endif
