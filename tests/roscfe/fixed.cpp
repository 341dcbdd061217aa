// What nodes do with texts and arrays of messages, on those of the strict profile. Prints the line of what is wrong.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "roscfe/fixed.h"

using roscfe::FixedString;
using roscfe::FixedVector;

static int g_wrong = 0;

#define CHECK(condition)                                          \
    do                                                            \
        if (!(condition))                                         \
        {                                                         \
            std::printf("%d: %s\n", __LINE__, #condition);        \
            ++g_wrong;                                            \
        }                                                         \
    while (0)

namespace roscfe
{
void refuse(const char *what, const char *detail)
{
    std::printf("%s: %s\n", what, detail);
    std::exit(g_wrong ? 1 : 3);
}
} // namespace roscfe

static std::string give(const std::string &text)
{
    return text;
}

static void texts()
{
    FixedString<8> a, b("map"), c(std::string("odom")), d(b), e(3, 'x');
    CHECK(a.empty() && a.size() == 0 && a == "" && !*a.c_str());
    CHECK(b == "map" && "map" == b && b == std::string("map") && std::string("map") == b && b == d && b != c);
    CHECK(e == "xxx" && b < c && c > b && b <= d && b >= "ma" && b < std::string("mb"));
    a = "base";
    a = std::string("base_");
    a += "li";
    a += 'n';
    CHECK(a == "base_lin" && a.length() == 8 && a.capacity() == 8);
    a = b;
    FixedString<20> wide(a);
    wide = c;
    CHECK(wide == c && wide != b && wide.compare(c) == 0 && wide.compare("odom") == 0 && b.compare("zz") < 0);
    std::string text = a;
    text = a;
    text += a;
    CHECK(text == "mapmap" && give(a) == "map" && a + "/x" == "map/x" && "/" + a == "/map" && a + a == "mapmap");
    CHECK(a + std::string("1") == "map1" && std::string("1") + a == "1map" && a + '/' == "map/" && '/' + a == "/map");
    CHECK(a.find('a') == 1 && a.find("p") == 2 && a.find("no") == std::string::npos && a.rfind('m') == 0);
    CHECK(a.find_first_of("pa") == 1 && a.find_last_of("am") == 1 && a.find_first_not_of("m") == 1);
    CHECK(a.substr(1) == "ap" && a.substr(0, 2) == "ma" && a.front() == 'm' && a.back() == 'p' && a.at(1) == 'a');
    a[0] = 't';
    a.push_back('e');
    CHECK(a == "tape");
    a.pop_back();
    a.resize(5, '!');
    CHECK(a == "tap!!" && a.c_str()[5] == '\0');
    a.erase(3);
    a.insert(0, "s");
    a.insert(2, a.view().substr(0, 2));
    CHECK(a == "ststap");
    a.erase(a.begin());
    a.append("x", 1).append(1, 'y');
    CHECK(a == "tstapxy");
    a.assign(text.begin(), text.end());
    CHECK(a == "mapmap" && std::string(a.begin(), a.end()) == "mapmap" && std::string(a.rbegin(), a.rend()) == "pampam");
    a = a.c_str() + 3; // a part of itself
    CHECK(a == "map");
    a.clear();
    CHECK(a.empty());
    a = std::string("a\0b", 3);
    CHECK(a.size() == 3 && a != "a");
    std::ostringstream out;
    out << b << 1;
    std::istringstream in("one two");
    in >> a;
    CHECK(out.str() == "map1" && a == "one");
    std::map<std::string, int> numbers;
    numbers[b] = 4;
    CHECK(numbers["map"] == 4 && std::strcmp(b.c_str(), "map") == 0);
    std::stringstream stream(b);
    CHECK(stream.str() == "map");
    b.swap(c);
    CHECK(b == "odom" && c == "map");
}

static void arrays()
{
    FixedVector<double, 4> a, b(2), c(2, 1.5), d{1, 2, 3};
    CHECK(a.empty() && b.size() == 2 && b[0] == 0 && c[1] == 1.5 && d.back() == 3 && a.capacity() == 4);
    a.push_back(1);
    a.emplace_back(2.0);
    a.insert(a.begin(), 0.5);
    CHECK(a.size() == 3 && a.front() == 0.5 && a.at(2) == 2);
    a.erase(a.begin() + 1);
    CHECK(a.size() == 2 && a[1] == 2);
    a.insert(a.end(), {3.0, 4.0});
    CHECK(a.size() == 4 && a[2] == 3 && a[3] == 4);
    a.erase(a.begin() + 2, a.end());
    a.resize(4, 9);
    CHECK(a[3] == 9);
    a.pop_back();
    a.erase(a.begin(), a.begin() + 2);
    CHECK(a.size() == 1 && a[0] == 9);
    std::vector<double> items(3, 4.0);
    a = items;
    items.clear();
    items = a;
    CHECK(items.size() == 3 && a == items && items == a && a != d);
    const std::vector<double> same(a);
    a.assign(same.begin() + 1, same.end());
    CHECK(a.size() == 2);
    a.assign(3, a[0]);
    a.assign({1, 2});
    a = {5, 6, 7};
    a.insert(a.begin() + 1, same.begin(), same.begin() + 1);
    CHECK(a.size() == 4 && a[0] == 5 && a[1] == 4 && a[3] == 7);
    FixedVector<double, 9> wide(a);
    CHECK(wide == a && wide.size() == 4);
    double sum = 0;
    for (const double &item : a)
        sum += item;
    CHECK(sum == 22 && *a.rbegin() == 7 && a.data() == &a[0] && a.end() - a.begin() == 4);
    a.clear();
    a.resize(2);
    CHECK(a[0] == 0 && a[1] == 0); // not what was there before
    a.reserve(100);
    a.swap(d);
    CHECK(a.size() == 3 && d.size() == 2);
    FixedVector<FixedString<4>, 2> names;
    names.push_back("one");
    names.resize(2);
    CHECK(names[0] == "one" && names[1].empty());
    const FixedVector<FixedString<4>, 2> copy(names);
    CHECK(copy == names);
    std::vector<std::string> joints{"a", "b"};
    names = joints; // the commonest of all: names of joints
    CHECK(names == joints && joints == names && names != copy);
    joints = copy;
    const std::vector<std::string> back = names;
    CHECK(joints[0] == "one" && joints[1].empty() && back[1] == "b");
    names = {"x", "y"};
    CHECK(names[0] == "x" && names.back() == "y");
    const FixedVector<FixedString<9>, 3> wider = names;
    CHECK(wider == names && std::find(wider.begin(), wider.end(), "y") == wider.begin() + 1);
    static_assert(!std::is_convertible<FixedVector<float, 2>, std::vector<double>>::value, "as std::vector");
}

int main(int, char **arguments)
{
    texts();
    arrays();
    FixedString<4>      text("four");
    FixedVector<int, 2> items{1, 2};
    switch (std::atoi(arguments[1]))
    {
    case 1: text += "5"; break;
    case 2: text = "12345"; break;
    case 3: text.resize(5); break;
    case 4: text.insert(1, "x"); break;
    case 5: text = std::string(70000, 'x'); break;
    case 6: text.push_back('5'); break;
    case 7: items.push_back(3); break;
    case 8: items.resize(3); break;
    case 9: items = std::vector<int>(3); break;
    case 10: items.insert(items.begin(), 0); break;
    case 11: items.assign(3, 1); break;
    case 12: items = {1, 2, 3}; break;
    case 13: text.at(4) = 'x'; break;
    case 14: items.at(2) = 1; break;
    case 15: text.substr(5); break;
    default: break;
    }
    return g_wrong ? 1 : 0;
}
