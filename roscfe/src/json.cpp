// Parameters as JSON: the texts that stand in the rows of a table of parameters.
#include "json.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscfe
{

using XmlRpc::XmlRpcValue;

namespace
{

constexpr int kDeepest = 32; // values in values

// What JSON lacks is an object with one member of such a name; one of the user's that looks like it is in "!!map".
constexpr char kBinary[]  = "!!binary";
constexpr char kTime[]    = "!!timestamp";
constexpr char kEscaped[] = "!!map";

constexpr char kSigns[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool from_base64(const std::string &text, XmlRpcValue::BinaryData &bytes)
{
    std::uint32_t bits  = 0;
    std::size_t   count = 0;
    for (const char sign : text)
    {
        const char *found = sign == '=' || sign == '\0' ? nullptr : std::strchr(kSigns, sign);
        if (found == nullptr && sign != '=')
        {
            return false;
        }
        bits = bits << 6 | static_cast<std::uint32_t>(found != nullptr ? found - kSigns : 0);
        if (++count % 4 == 0)
        {
            bytes.insert(bytes.end(), {static_cast<char>(bits >> 16), static_cast<char>(bits >> 8), static_cast<char>(bits)});
        }
    }
    const std::size_t filled = text.size() - std::min(text.find('='), text.size());
    if (count % 4 != 0 || filled > 2)
    {
        return false;
    }
    bytes.resize(bytes.size() - filled);
    return true;
}

// Without ends of lines, or with one behind each 72 characters and at the end.
std::string to_base64(const XmlRpcValue::BinaryData &bytes, bool in_lines)
{
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3)
    {
        std::uint32_t     bits = 0;
        const std::size_t here = std::min<std::size_t>(3, bytes.size() - at);
        for (std::size_t i = 0; i < 3; ++i)
        {
            bits = bits << 8 | (i < here ? static_cast<std::uint8_t>(bytes[at + i]) : 0u);
        }
        for (std::size_t i = 0; i < 4; ++i)
        {
            text += i <= here ? kSigns[bits >> (18 - 6 * i) & 63] : '=';
        }
        if (in_lines && here == 3 && (at / 3 + 1) % 18 == 0)
        {
            text += '\n';
        }
    }
    return in_lines ? text + '\n' : text;
}

// A date as XML-RPC has it, "20261121T18:50:00"; std::tm has its numbers as they are, as in roscpp.
bool from_date(const std::string &text, std::tm &date)
{
    date           = std::tm();
    date.tm_isdst  = -1;
    const char *at = text.c_str();
    struct Part
    {
        int *       number;
        int         digits;
        const char *end;
    };
    for (const Part &part : {Part{&date.tm_year, 4, ""}, Part{&date.tm_mon, 2, ""}, Part{&date.tm_mday, 2, "T"},
                             Part{&date.tm_hour, 2, ":"}, Part{&date.tm_min, 2, ":"}, Part{&date.tm_sec, 2, ""}})
    {
        at += std::strspn(at, " ");
        const char *begin = at;
        for (; at - begin < part.digits && *at >= '0' && *at <= '9'; ++at)
        {
            *part.number = *part.number * 10 + (*at - '0');
        }
        if (at == begin || std::strncmp(at, part.end, std::strlen(part.end)) != 0)
        {
            return false;
        }
        at += std::strlen(part.end);
    }
    return true;
}

bool is_marked(const XmlRpcValue &value)
{
    return value.size() == 1 && (value.hasMember(kBinary) || value.hasMember(kTime) || value.hasMember(kEscaped));
}

bool restore(XmlRpcValue &value);

bool restore_members(XmlRpcValue &value)
{
    bool good = true;
    for (auto &each : value)
    {
        good = good && restore(each.second);
    }
    return good;
}

// Structs that stand for what JSON lacks become that; false when there is nothing of the kind.
bool restore(XmlRpcValue &value)
{
    if (value.getType() == XmlRpcValue::TypeArray)
    {
        bool good = true;
        for (int i = 0; i < value.size(); ++i)
        {
            good = good && restore(value[i]);
        }
        return good;
    }
    if (value.getType() != XmlRpcValue::TypeStruct)
    {
        return true;
    }
    if (!is_marked(value))
    {
        return restore_members(value);
    }
    const std::string mark = value.begin()->first;
    const XmlRpcValue said = value.begin()->second;
    if (mark == kEscaped)
    {
        value = said;
        return said.getType() == XmlRpcValue::TypeStruct && restore_members(value);
    }
    XmlRpcValue::BinaryData bytes;
    std::tm                 date;
    if (said.getType() != XmlRpcValue::TypeString || !(mark == kBinary ? from_base64(said, bytes) : from_date(said, date)))
    {
        return false;
    }
    value = mark == kBinary ? XmlRpcValue(bytes.data(), static_cast<int>(bytes.size())) : XmlRpcValue(&date);
    return true;
}

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
        return *at_ == '\0' && restore(value);
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
                return read_string(value);
            case 't':
            case 'f':
                value = XmlRpcValue(*at_ == 't');
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
            value = XmlRpcValue(std::strtod(begin, nullptr));
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
            value = XmlRpcValue(std::strtod(begin, nullptr));
            return true;
        }
        const long long number = std::strtoll(begin, nullptr, 10);
        if (number < INT32_MIN || number > INT32_MAX)
        {
            return false; // XML-RPC has 32 bits
        }
        value = XmlRpcValue(static_cast<int>(number));
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

    bool read_string(XmlRpcValue &value)
    {
        std::string text;
        const bool  good = read_text(text);
        value            = XmlRpcValue(text);
        return good;
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
        value.setSize(0);
        ++at_;
        skip();
        if (*at_ == ']')
        {
            ++at_;
            return true;
        }
        for (;;)
        {
            if (!read(value[value.size()], depth + 1))
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
        value.begin(); // it is a struct from now on
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
            if (*at_++ != ':' || !read(value[name], depth + 1))
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

std::string date_text(const std::tm &date)
{
    char text[40];
    std::snprintf(text, sizeof text, "%4d%02d%02dT%02d:%02d:%02d", date.tm_year, date.tm_mon, date.tm_mday, date.tm_hour,
                  date.tm_min, date.tm_sec);
    return text;
}

void write_marked(const char *mark, const std::string &said, std::string &to)
{
    to += "{\"";
    to += mark;
    to += "\": ";
    write_text(said, to);
    to += '}';
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
            to += static_cast<bool>(value) ? "true" : "false";
            return;
        case XmlRpcValue::TypeInt:
            to += std::to_string(static_cast<int>(value));
            return;
        case XmlRpcValue::TypeDouble:
            write_number(value, to);
            return;
        case XmlRpcValue::TypeString:
            write_text(value, to);
            return;
        case XmlRpcValue::TypeDateTime:
        {
            const std::string text = date_text(value);
            write_marked(kTime, text.substr(text.find_first_not_of(' ')), to); // as the master strips it
            return;
        }
        case XmlRpcValue::TypeBase64:
            write_marked(kBinary, to_base64(value, false), to);
            return;
        case XmlRpcValue::TypeArray:
            to += '[';
            for (int i = 0; i < value.size(); ++i)
            {
                to += i > 0 ? ", " : "";
                write(value[i], to);
            }
            to += ']';
            return;
        case XmlRpcValue::TypeStruct:
        {
            const char *before = "";
            const bool  marked = is_marked(value);
            to += marked ? "{\"!!map\": {" : "{";
            for (const auto &each : value)
            {
                to += before;
                write_text(each.first, to);
                to += ": ";
                write(each.second, to);
                before = ", ";
            }
            to += marked ? "}}" : "}";
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

std::string XmlRpcValue::dateText() const
{
    return roscfe::date_text(*this);
}

std::string XmlRpcValue::base64Lines() const
{
    return roscfe::to_base64(*this, true);
}

std::string XmlRpcValue::toJson() const
{
    std::string text;
    roscfe::write(*this, text);
    return text;
}

} // namespace XmlRpc
