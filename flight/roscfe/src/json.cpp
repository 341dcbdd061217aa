// Parameters as JSON: the texts that stand in the rows of a table of parameters.
#include "json.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscfe
{

using XmlRpc::Access;
using XmlRpc::XmlRpcValue;

namespace
{

constexpr int kDeepest = 32; // values in values

class Reader
{
  public:
    explicit Reader(const char *text) : at_(text) {}

    bool read_all(XmlRpcValue &value)
    {
        if (!read(value, 0))
        {
            return false;
        }
        skip();
        return *at_ == '\0';
    }

  private:
    void skip()
    {
        while (*at_ == ' ' || *at_ == '\t' || *at_ == '\n' || *at_ == '\r')
        {
            ++at_;
        }
    }

    bool word(const char *text)
    {
        const std::size_t size = std::strlen(text);
        if (std::strncmp(at_, text, size) != 0)
        {
            return false;
        }
        at_ += size;
        return true;
    }

    bool read(XmlRpcValue &value, int depth)
    {
        skip();
        if (depth > kDeepest)
        {
            return false;
        }
        switch (*at_)
        {
            case '{':
                return read_members(value, depth);
            case '[':
                return read_array(value, depth);
            case '"':
                Access::make(value, XmlRpcValue::TypeString);
                return read_text(Access::text(value));
            case 't':
            case 'f':
                Access::make(value, XmlRpcValue::TypeBoolean);
                Access::boolean(value) = *at_ == 't';
                return word(*at_ == 't' ? "true" : "false");
            default:
                return read_number(value);
        }
    }

    std::size_t digits(const char *at) const { return std::strspn(at, "0123456789"); }

    // A number as JSON has it: 007, +1 and .5 are texts.
    bool read_number(XmlRpcValue &value)
    {
        const char *begin = at_;
        if (word("NaN") || word("Infinity") || word("-Infinity"))
        {
            Access::make(value, XmlRpcValue::TypeDouble);
            Access::number(value) = std::strtod(begin, nullptr);
            return true;
        }
        const char *      end   = begin + (*begin == '-' ? 1 : 0);
        const std::size_t whole = digits(end);
        if (whole == 0 || (whole > 1 && *end == '0'))
        {
            return false;
        }
        end += whole;
        const char *behind = end;
        if (*end == '.' && digits(end + 1) > 0)
        {
            end += 1 + digits(end + 1);
        }
        if (*end == 'e' || *end == 'E')
        {
            const char *exponent = end + (end[1] == '-' || end[1] == '+' ? 2 : 1);
            end                  = digits(exponent) > 0 ? exponent + digits(exponent) : end;
        }
        at_ = end;
        if (end != behind)
        {
            Access::make(value, XmlRpcValue::TypeDouble);
            Access::number(value) = std::strtod(begin, nullptr);
            return true;
        }
        const long long number = std::strtoll(begin, nullptr, 10);
        if (number < INT32_MIN || number > INT32_MAX)
        {
            return false; // XML-RPC has 32 bits
        }
        Access::make(value, XmlRpcValue::TypeInt);
        Access::integer(value) = static_cast<int>(number);
        return true;
    }

    bool read_text(std::string &text)
    {
        ++at_;
        while (*at_ != '"')
        {
            if (*at_ == '\0')
            {
                return false;
            }
            if (*at_ != '\\')
            {
                text += *at_++;
                continue;
            }
            ++at_;
            switch (*at_++)
            {
                case 'n':
                    text += '\n';
                    break;
                case 't':
                    text += '\t';
                    break;
                case 'r':
                    text += '\r';
                    break;
                case 'b':
                    text += '\b';
                    break;
                case 'f':
                    text += '\f';
                    break;
                case 'u':
                    if (!read_code_point(text))
                    {
                        return false;
                    }
                    break;
                case '\0':
                    return false;
                default:
                    text += at_[-1];
            }
        }
        ++at_;
        return true;
    }

    bool hexadecimal(std::uint32_t &value)
    {
        value = 0;
        for (int i = 0; i < 4; ++i)
        {
            const char c = *at_;
            if (std::strchr("0123456789abcdefABCDEF", c) == nullptr || c == '\0')
            {
                return false;
            }
            value = value * 16 + static_cast<std::uint32_t>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
            ++at_;
        }
        return true;
    }

    bool read_code_point(std::string &text)
    {
        std::uint32_t point = 0;
        if (!hexadecimal(point))
        {
            return false;
        }
        if (point >= 0xD800 && point < 0xDC00 && at_[0] == '\\' && at_[1] == 'u') // the first half of a pair
        {
            std::uint32_t second = 0;
            at_ += 2;
            if (!hexadecimal(second))
            {
                return false;
            }
            point = 0x10000 + ((point - 0xD800) << 10) + (second - 0xDC00);
        }
        const int more = point < 0x80 ? 0 : point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
        static const std::uint8_t kLead[] = {0x00, 0xC0, 0xE0, 0xF0};
        text += static_cast<char>(kLead[more] | (point >> (6 * more)));
        for (int i = more - 1; i >= 0; --i)
        {
            text += static_cast<char>(0x80 | ((point >> (6 * i)) & 0x3F));
        }
        return true;
    }

    bool read_array(XmlRpcValue &value, int depth)
    {
        Access::make(value, XmlRpcValue::TypeArray);
        ++at_;
        skip();
        if (*at_ == ']')
        {
            ++at_;
            return true;
        }
        for (;;)
        {
            Access::array(value).emplace_back();
            if (!read(Access::array(value).back(), depth + 1))
            {
                return false;
            }
            skip();
            if (*at_ == ']')
            {
                ++at_;
                return true;
            }
            if (*at_++ != ',')
            {
                return false;
            }
        }
    }

    bool read_members(XmlRpcValue &value, int depth)
    {
        Access::make(value, XmlRpcValue::TypeStruct);
        ++at_;
        skip();
        if (*at_ == '}')
        {
            ++at_;
            return true;
        }
        for (;;)
        {
            std::string name;
            skip();
            if (*at_ != '"' || !read_text(name))
            {
                return false;
            }
            skip();
            if (*at_++ != ':' || !read(Access::members(value)[name], depth + 1))
            {
                return false;
            }
            skip();
            if (*at_ == '}')
            {
                ++at_;
                return true;
            }
            if (*at_++ != ',')
            {
                return false;
            }
        }
    }

    const char *at_;
};

void write_text(const std::string &text, std::string &to)
{
    to += '"';
    for (const char c : text)
    {
        if (c == '"' || c == '\\')
        {
            to += '\\';
            to += c;
        }
        else if (static_cast<unsigned char>(c) < 0x20)
        {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
            to += code;
        }
        else
        {
            to += c;
        }
    }
    to += '"';
}

void write_number(double number, std::string &to)
{
    if (std::isnan(number) || std::isinf(number))
    {
        to += std::isnan(number) ? "NaN" : number < 0 ? "-Infinity" : "Infinity";
        return;
    }
    char text[40];
    for (int digits = 15; digits <= 17; ++digits) // the fewest that read back as the same number
    {
        std::snprintf(text, sizeof text, "%.*g", digits, number);
        if (std::strtod(text, nullptr) == number)
        {
            break;
        }
    }
    to += text;
    if (std::strpbrk(text, ".e") == nullptr)
    {
        to += ".0"; // a double stays one
    }
}

void write(const XmlRpcValue &value, std::string &to)
{
    switch (value.getType())
    {
        case XmlRpcValue::TypeBoolean:
            to += Access::boolean(value) ? "true" : "false";
            return;
        case XmlRpcValue::TypeInt:
            to += std::to_string(Access::integer(value));
            return;
        case XmlRpcValue::TypeDouble:
            write_number(Access::number(value), to);
            return;
        case XmlRpcValue::TypeString:
            write_text(Access::text(value), to);
            return;
        case XmlRpcValue::TypeArray:
        {
            const char *before = "[";
            for (const XmlRpcValue &each : Access::array(value))
            {
                to += before;
                write(each, to);
                before = ", ";
            }
            to += Access::array(value).empty() ? "[]" : "]";
            return;
        }
        case XmlRpcValue::TypeStruct:
        {
            const char *before = "{";
            for (const auto &each : Access::members(value))
            {
                to += before;
                write_text(each.first, to);
                to += ": ";
                write(each.second, to);
                before = ", ";
            }
            to += Access::members(value).empty() ? "{}" : "}";
            return;
        }
        default:
            to += "null";
    }
}

} // namespace

void from_json(const char *text, XmlRpcValue &value)
{
    value = XmlRpcValue();
    if (!Reader(text).read_all(value))
    {
        value = XmlRpcValue(text); // a text needs no quotes where it is read as nothing else
    }
}

} // namespace roscfe

namespace XmlRpc
{

std::string XmlRpcValue::toJson() const
{
    std::string text;
    roscfe::write(*this, text);
    return text;
}

} // namespace XmlRpc
