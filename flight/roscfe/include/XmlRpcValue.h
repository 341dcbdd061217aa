// XmlRpc::XmlRpcValue: a parameter of any type, as a node gets it from getParam.
#ifndef ROSCFE_XMLRPCVALUE_H
#define ROSCFE_XMLRPCVALUE_H

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
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
    XmlRpcValue(bool value) : type_(TypeBoolean), boolean_(value) {}
    XmlRpcValue(int value) : type_(TypeInt), int_(value) {}
    XmlRpcValue(double value) : type_(TypeDouble), double_(value) {}
    XmlRpcValue(const std::string &value) : type_(TypeString), text_(value) {}
    XmlRpcValue(const char *value) : type_(TypeString), text_(value) {}

    XmlRpcValue &operator=(bool value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(int value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(double value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(const std::string &value) { return *this = XmlRpcValue(value); }
    XmlRpcValue &operator=(const char *value) { return *this = XmlRpcValue(value); }

    Type getType() const { return type_; }
    bool valid() const { return type_ != TypeInvalid; }
    void clear() { *this = XmlRpcValue(); }

    // Reading another type than the value has is an XmlRpcException; an invalid value becomes what is asked for.
    operator bool &() { return is(TypeBoolean).boolean_; }
    operator int &() { return is(TypeInt).int_; }
    operator double &() { return is(TypeDouble).double_; }
    operator std::string &() { return is(TypeString).text_; }
    operator const bool &() const { return is(TypeBoolean).boolean_; }
    operator const int &() const { return is(TypeInt).int_; }
    operator const double &() const { return is(TypeDouble).double_; }
    operator const std::string &() const { return is(TypeString).text_; }

    // Number of characters, elements or members.
    int size() const
    {
        switch (type_)
        {
            case TypeString:
                return static_cast<int>(text_.size());
            case TypeArray:
                return static_cast<int>(array_.size());
            case TypeStruct:
                return static_cast<int>(members_.size());
            default:
                XmlRpcException::fail("type error");
        }
    }
    void setSize(int size)
    {
        ValueArray &array = is(TypeArray).array_;
        if (static_cast<int>(array.size()) < size) // it never becomes smaller
        {
            array.resize(static_cast<std::size_t>(size));
        }
    }
    bool hasMember(const std::string &name) const { return type_ == TypeStruct && members_.count(name) > 0; }

    XmlRpcValue &operator[](int index)
    {
        ValueArray &array = is(TypeArray).array_;
        if (index >= static_cast<int>(array.size()))
        {
            array.resize(static_cast<std::size_t>(index) + 1);
        }
        return array[static_cast<std::size_t>(index)];
    }
    const XmlRpcValue &operator[](int index) const
    {
        const ValueArray &array = is(TypeArray).array_;
        if (index < 0 || index >= static_cast<int>(array.size()))
        {
            XmlRpcException::fail("range error: array index too large");
        }
        return array[static_cast<std::size_t>(index)];
    }
    XmlRpcValue &operator[](const std::string &name) { return is(TypeStruct).members_[name]; }
    XmlRpcValue &operator[](const char *name) { return is(TypeStruct).members_[name]; }
    const XmlRpcValue &operator[](const std::string &name) const
    {
        const ValueStruct &members = is(TypeStruct).members_;
        const auto         found   = members.find(name);
        if (found == members.end())
        {
            static const XmlRpcValue none;
            return none;
        }
        return found->second;
    }
    const XmlRpcValue &operator[](const char *name) const { return (*this)[std::string(name)]; }

    iterator       begin() { return is(TypeStruct).members_.begin(); }
    iterator       end() { return is(TypeStruct).members_.end(); }
    const_iterator begin() const { return is(TypeStruct).members_.begin(); }
    const_iterator end() const { return is(TypeStruct).members_.end(); }

    bool operator==(const XmlRpcValue &other) const
    {
        return type_ == other.type_ && boolean_ == other.boolean_ && int_ == other.int_ && double_ == other.double_ &&
               text_ == other.text_ && array_ == other.array_ && members_ == other.members_;
    }
    bool operator!=(const XmlRpcValue &other) const { return !(*this == other); }

    // As roscpp writes it: {1,two} for an array, [name:value] for a struct.
    std::ostream &write(std::ostream &stream) const
    {
        switch (type_)
        {
            case TypeBoolean:
                return stream << boolean_;
            case TypeInt:
                return stream << int_;
            case TypeDouble:
                return stream << double_;
            case TypeString:
                return stream << text_;
            case TypeArray:
                stream << '{';
                for (const XmlRpcValue &each : array_)
                {
                    each.write(&each == &array_.front() ? stream : stream << ',');
                }
                return stream << '}';
            case TypeStruct:
                stream << '[';
                for (auto each = members_.begin(); each != members_.end(); ++each)
                {
                    each->second.write((each == members_.begin() ? stream : stream << ',') << each->first << ':');
                }
                return stream << ']';
            default:
                return stream;
        }
    }

    // As JSON, which stands in the tables of parameters.
    std::string toJson() const;

  private:
    XmlRpcValue &is(Type type)
    {
        if (type_ == TypeInvalid)
        {
            type_ = type;
        }
        else if (type_ != type)
        {
            mismatch(type);
        }
        return *this;
    }
    const XmlRpcValue &is(Type type) const
    {
        if (type_ != type)
        {
            mismatch(type);
        }
        return *this;
    }

    [[noreturn]] static void mismatch(Type wanted)
    {
        XmlRpcException::fail(wanted == TypeArray    ? "type error: expected an array"
                              : wanted == TypeStruct ? "type error: expected a struct"
                                                     : "type error");
    }

    friend class Access;

    Type        type_    = TypeInvalid;
    bool        boolean_ = false;
    int         int_     = 0;
    double      double_  = 0;
    std::string text_;
    ValueArray  array_;
    ValueStruct members_;
};

inline std::ostream &operator<<(std::ostream &stream, const XmlRpcValue &value)
{
    return value.write(stream);
}

// For the library, which never asks for what a value is not.
class Access
{
  public:
    static void make(XmlRpcValue &value, XmlRpcValue::Type type) { value.type_ = type; }

    template <class V>
    static auto &boolean(V &value)
    {
        return value.boolean_;
    }
    template <class V>
    static auto &integer(V &value)
    {
        return value.int_;
    }
    template <class V>
    static auto &number(V &value)
    {
        return value.double_;
    }
    template <class V>
    static auto &text(V &value)
    {
        return value.text_;
    }
    template <class V>
    static auto &array(V &value)
    {
        return value.array_;
    }
    template <class V>
    static auto &members(V &value)
    {
        return value.members_;
    }
};

} // namespace XmlRpc

#endif
