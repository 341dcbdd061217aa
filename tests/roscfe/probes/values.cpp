// XmlRpcValue: what it takes, gives, prints and throws.
#include <cstdio>
#include <sstream>

#include <xmlrpcpp/XmlRpcException.h>
#include <ros/ros.h>

typedef XmlRpc::XmlRpcValue Value;

template <class Function>
void print(const char *expression, Function function)
{
    std::ostringstream out;
    try
    {
        function(out);
    }
    catch (const XmlRpc::XmlRpcException &error)
    {
        out << "XmlRpcException " << error.getMessage() << " " << error.getCode();
    }
    std::printf("P| %s: %s\n", expression, out.str().c_str());
}

#define PRINT(expression) print(#expression, [&](std::ostream &out) { out << (expression); })
#define DO(statement) print(#statement, [&](std::ostream &out) { statement; out << "done"; })

int main(int argc, char **argv)
{
    ros::init(argc, argv, "values");
    Value nothing, yes(true), three(3), half(0.5), word("word"), list, tree;
    char      bytes[100];
    for (int i = 0; i < 100; ++i)
    {
        bytes[i] = static_cast<char>(i * 5);
    }
    std::tm date = {};
    date.tm_year = 2026, date.tm_mon = 11, date.tm_mday = 3, date.tm_hour = 18, date.tm_sec = 7;
    Value       binary(bytes, 100), nil(bytes, 0), when(&date);
    std::tm     short_year = date;
    short_year.tm_year     = 126;
    list[0] = 1;
    list[2] = "x";
    tree["a"] = 1;
    tree["b"]["c"] = 2.25;
    const Value constant = tree, fixed = list, text = word;
    for (const Value *each : {&nothing, &yes, &three, &half, &word, &list, &tree, &binary, &nil, &when})
    {
        const Value &of = *each;
        PRINT(of.getType());
        PRINT(of.valid());
        PRINT(of);
        PRINT(of.size());
        PRINT(of.hasMember("a"));
        PRINT(static_cast<int>(Value(of)));
        PRINT(static_cast<double>(Value(of)));
        PRINT(static_cast<bool>(Value(of)));
        PRINT(static_cast<std::string>(Value(of)));
        PRINT(Value(of)[0]);
        PRINT(Value(of)["a"]);
        PRINT(of == three);
        PRINT(of != three);
    }
    PRINT(Value(bytes, 1));
    PRINT(Value(bytes, 2));
    PRINT(Value(bytes, 3));
    PRINT(Value(bytes, 54));
    PRINT(Value(bytes, 55));
    PRINT(Value(bytes, 100) == binary);
    PRINT(Value(bytes, 99) == binary);
    PRINT(static_cast<const Value::BinaryData &>(binary).size());
    PRINT(static_cast<const Value::BinaryData &>(when).size());
    PRINT(static_cast<const std::tm &>(when).tm_mon);
    PRINT(static_cast<const std::tm &>(binary).tm_mon);
    PRINT(Value(&short_year));
    PRINT(Value(&short_year) == when);
    DO(date.tm_wday = 3);
    PRINT(Value(&date) == when);
    DO(static_cast<Value::BinaryData &>(nil).push_back('x'));
    PRINT(nil);
    DO(Value().operator Value::BinaryData &().size());
    DO(Value().operator std::tm &().tm_mon = 3);
    PRINT(static_cast<int>(half));
    PRINT(static_cast<double>(three));
    PRINT(static_cast<const double &>(constant["b"]["c"]));
    PRINT(constant["absent"]);
    PRINT(fixed[1]);
    PRINT(fixed[3]);
    PRINT(fixed["a"]);
    PRINT(constant[0]);
    PRINT(static_cast<const std::string &>(text));
    PRINT(tree["new"].valid());
    PRINT(tree.size());
    PRINT(list[5].getType());
    PRINT(list.size());
    DO(list.setSize(1));
    PRINT(list);
    DO(three.setSize(1));
    DO(word.clear());
    PRINT(word.valid());
    PRINT(Value(1.0));
    PRINT(Value(0.1));
    PRINT(Value(1e20));
    PRINT(Value(-5));
    PRINT(Value(false));
    PRINT(Value("a<b>&\"c\""));
    PRINT(Value(""));
    DO(static_cast<int &>(nothing) = 4);
    PRINT(nothing);
    PRINT(static_cast<double>(nothing));
    for (auto &member : tree)
    {
        std::printf("P| member %s of type %d\n", member.first.c_str(), member.second.getType());
    }
    DO(list.begin());
    DO(three = "now text");
    PRINT(three);
    PRINT(Value(std::string("s")) == Value("s"));
    PRINT(tree == constant);
    PRINT(Value() == Value());
    return 0;
}
