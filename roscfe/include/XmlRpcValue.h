// XmlRpc::XmlRpcValue: a parameter of any type, as a node gets it from getParam.
#ifndef ROSCFE_XMLRPCVALUE_H
#define ROSCFE_XMLRPCVALUE_H

#include <cstdint>
#include <ctime>
#include <map>
#include <ostream>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "XmlRpcException.h"

namespace XmlRpc
{

class XmlRpcValue
{
  public:
    enum Type
    {
        TypeInvalid,
        TypeBoolean,
        TypeInt,
        TypeDouble,
        TypeString,
        TypeDateTime,
        TypeBase64,
        TypeArray,
        TypeStruct
    };

    typedef std::vector<char>                  BinaryData;
    typedef std::vector<XmlRpcValue>           ValueArray;
    typedef std::map<std::string, XmlRpcValue> ValueStruct;
    typedef ValueStruct::iterator              iterator;
    typedef ValueStruct::const_iterator        const_iterator;

    XmlRpcValue() {}
    XmlRpcValue(bool value) : value_(std::in_place_type<bool>, value) {}
    XmlRpcValue(int value) : value_(std::in_place_type<int>, value) {}
    XmlRpcValue(double value) : value_(std::in_place_type<double>, value) {}
    XmlRpcValue(const std::string &value) : value_(std::in_place_type<std::string>, value) {}
    XmlRpcValue(const char *value) : value_(std::in_place_type<std::string>, value) {}
    XmlRpcValue(std::tm *value) : value_(std::in_place_type<Date>, *value) {}
    XmlRpcValue(void *value, int size)
        : value_(std::in_place_type<BinaryData>, static_cast<char *>(value), static_cast<char *>(value) + size)
    {
    }

    XmlRpcValue &operator=(bool value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(int value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(double value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(const std::string &value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(const char *value) { return *this = XmlRpcValue(value); }

    Type getType() const { return static_cast<Type>(value_.index()); }
    bool valid() const { return getType() != TypeInvalid; }
    void clear() { *this = XmlRpcValue(); }

    // Reading another type than the value has is an XmlRpcException; an invalid value becomes what is asked for.
    operator bool &() { return as<bool>(); }
    operator int &() { return as<int>(); }
    operator double &() { return as<double>(); }
    operator std::string &() { return as<std::string>(); }
    operator BinaryData &() { return as<BinaryData>(); }
    operator std::tm &() { return as<std::tm>(); }
    operator const bool &() const { return as<bool>(); }
    operator const int &() const { return as<int>(); }
    operator const double &() const { return as<double>(); }
    operator const std::string &() const { return as<std::string>(); }
    operator const BinaryData &() const { return as<BinaryData>(); }
    operator const std::tm &() const { return as<std::tm>(); }

    // Number of characters, bytes, elements or members.
    int size() const
    {
        switch (getType())
        {
            case TypeString:
                return static_cast<int>(as<std::string>().size());
            case TypeBase64:
                return static_cast<int>(as<BinaryData>().size());
            case TypeArray:
                return static_cast<int>(as<ValueArray>().size());
            case TypeStruct:
                return static_cast<int>(as<ValueStruct>().size());
            default:
                XmlRpcException::fail("type error");
        }
    }
    void setSize(int size)
    {
        ValueArray &array = as<ValueArray>();
        if (static_cast<int>(array.size()) < size) // it never becomes smaller
        {
            array.resize(static_cast<std::size_t>(size));
        }
    }
    bool hasMember(const char *name) const
    {
        return getType() == TypeStruct && member(as<ValueStruct>(), name) != nullptr;
    }
    bool hasMember(const std::string &name) const { return hasMember(name.c_str()); }

    XmlRpcValue &operator[](int index)
    {
        ValueArray &array = as<ValueArray>();
        if (index >= static_cast<int>(array.size()))
        {
            array.resize(static_cast<std::size_t>(index) + 1);
        }
        return array[static_cast<std::size_t>(index)];
    }
    const XmlRpcValue &operator[](int index) const
    {
        const ValueArray &array = as<ValueArray>();
        if (index < 0 || index >= static_cast<int>(array.size()))
        {
            XmlRpcException::fail("range error: array index too large");
        }
        return array[static_cast<std::size_t>(index)];
    }
    XmlRpcValue &operator[](const std::string &name) { return as<ValueStruct>()[name]; }
    XmlRpcValue &operator[](const char *name)
    {
        XmlRpcValue *const found = member(as<ValueStruct>(), name);
        return found != nullptr ? *found : as<ValueStruct>()[name];
    }
    const XmlRpcValue &operator[](const char *name) const
    {
        static const XmlRpcValue none;
        const XmlRpcValue *const found = member(as<ValueStruct>(), name);
        return found != nullptr ? *found : none;
    }
    const XmlRpcValue &operator[](const std::string &name) const { return (*this)[name.c_str()]; }

    iterator       begin() { return as<ValueStruct>().begin(); }
    iterator       end() { return as<ValueStruct>().end(); }
    const_iterator begin() const { return as<ValueStruct>().begin(); }
    const_iterator end() const { return as<ValueStruct>().end(); }

    bool operator==(const XmlRpcValue &other) const { return value_ == other.value_; }
    bool operator!=(const XmlRpcValue &other) const { return !(*this == other); }

    // As roscpp writes it: {1,two} for an array, [name:value] for a struct, a date as its numbers are, base64 in lines.
    std::ostream &write(std::ostream &stream) const
    {
        switch (getType())
        {
            case TypeBoolean:
                return stream << as<bool>();
            case TypeInt:
                return stream << as<int>();
            case TypeDouble:
            {
                const std::streamsize before = stream.precision(16);
                stream << as<double>();
                stream.precision(before);
                return stream;
            }
            case TypeString:
                return stream << as<std::string>();
            case TypeDateTime:
                return stream << dateText();
            case TypeBase64:
                return stream << base64Lines();
            case TypeArray:
                stream << '{';
                for (const XmlRpcValue &each : as<ValueArray>())
                {
                    each.write(&each == &as<ValueArray>().front() ? stream : stream << ',');
                }
                return stream << '}';
            case TypeStruct:
                stream << '[';
                for (auto each = begin(); each != end(); ++each)
                {
                    each->second.write((each == begin() ? stream : stream << ',') << each->first << ':');
                }
                return stream << ']';
            default:
                return stream;
        }
    }

    // As JSON, which stands in the tables of parameters.
    std::string toJson() const;

  private:
    // std::tm has no comparison of its own; roscpp's looks at what XML-RPC carries.
    struct Date : std::tm
    {
        Date(const std::tm &value) : std::tm(value) {}
        bool operator==(const Date &other) const
        {
            return tm_sec == other.tm_sec && tm_min == other.tm_min && tm_hour == other.tm_hour &&
                   tm_mday == other.tm_mday && tm_mon == other.tm_mon && tm_year == other.tm_year;
        }
    };

    template <class T>
    using Kept = std::conditional_t<std::is_same<T, std::tm>::value, Date, T>;

    template <class T>
    T &as()
    {
        if (!valid())
        {
            value_.template emplace<Kept<T>>(T());
        }
        check<T>();
        return *std::get_if<Kept<T>>(&value_);
    }
    template <class T>
    const T &as() const
    {
        check<T>();
        return *std::get_if<Kept<T>>(&value_);
    }
    template <class T>
    void check() const
    {
        if (!std::holds_alternative<Kept<T>>(value_))
        {
            XmlRpcException::fail(std::is_same<T, ValueArray>::value    ? "type error: expected an array"
                                  : std::is_same<T, ValueStruct>::value ? "type error: expected a struct"
                                                                        : "type error");
        }
    }

    // A member by its name, of which no std::string is made; null when there is none.
    template <class Members>
    static auto member(Members &members, const char *name) -> decltype(&members.begin()->second)
    {
        for (auto &each : members)
        {
            if (each.first == name)
            {
                return &each.second;
            }
        }
        return nullptr;
    }

    std::string dateText() const;
    std::string base64Lines() const;

    // In the order of the types.
    std::variant<std::monostate, bool, int, double, std::string, Date, BinaryData, ValueArray, ValueStruct> value_;
};

inline std::ostream &operator<<(std::ostream &stream, const XmlRpcValue &value)
{
    return value.write(stream);
}

} // namespace XmlRpc

#endif
