// What nodes use of Boost. It compiles against Boost itself as well: boost.txt is what it prints there.
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/array.hpp>
#include <boost/bind.hpp>
#include <boost/cstdint.hpp>
#include <boost/enable_shared_from_this.hpp>
#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <boost/noncopyable.hpp>
#include <boost/pointer_cast.hpp>
#include <boost/ref.hpp>
#include <boost/scoped_array.hpp>
#include <boost/scoped_ptr.hpp>
#include <boost/shared_array.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/utility/enable_if.hpp>
#include <boost/weak_ptr.hpp>

struct Base
{
    virtual ~Base() { std::printf("gone\n"); }
    int value = 1;
};

struct Derived : Base, boost::enable_shared_from_this<Derived>
{
    boost::shared_ptr<Derived> self() { return shared_from_this(); }
    int                        add(int a, int b) { return value + a + b; }
    int                        get() const { return value; }
    void                       take(const boost::shared_ptr<int const> &number) { value = *number; }
};

class Alone : private boost::noncopyable
{
  public:
    int value = 5;
};

static int sum(int a, int b)
{
    return 10 * a + b;
}

static void increase(int &value)
{
    ++value;
}

static void pointers()
{
    boost::shared_ptr<Derived> derived = boost::make_shared<Derived>();
    boost::shared_ptr<Base>    base    = derived;
    boost::weak_ptr<Derived>   weak    = derived;
    std::printf("%d %d\n", boost::static_pointer_cast<Derived>(base) == derived,
                boost::dynamic_pointer_cast<Derived>(base)->self() == derived);
    boost::shared_ptr<Base const> fixed = base;
    boost::const_pointer_cast<Base>(fixed)->value = 7;
    const long uses = derived.use_count();
    std::printf("%d %ld\n", weak.lock()->value, uses);
    derived.reset();
    base.reset();
    std::printf("%d\n", weak.expired());
    fixed.reset();
    std::printf("%d %d\n", weak.expired(), !weak.lock());

    boost::scoped_ptr<Alone> alone(new Alone);
    alone->value += 1;
    std::printf("%d %d\n", (*alone).value, alone ? 1 : 0);
    alone.reset();
    std::printf("%d %d\n", !alone, alone.get() == nullptr);
    boost::shared_array<int> shared(new int[3]{1, 2, 3});
    boost::scoped_array<int> scoped(new int[2]{4, 5});
    std::printf("%d %d\n", shared[2], scoped[1]);
    boost::shared_ptr<void> any = boost::make_shared<std::string>("any");
    std::printf("%s\n", boost::static_pointer_cast<std::string>(any)->c_str());
}

static void callables()
{
    Derived                    object;
    boost::shared_ptr<Derived> shared = boost::make_shared<Derived>();
    boost::function<int(int)>  call   = boost::bind(&Derived::add, &object, _1, 20);
    std::printf("%d\n", call(300));
    call = boost::bind(sum, 2, _1);
    std::printf("%d\n", call(3));
    boost::function<int(int, int)> swapped = boost::bind(&sum, _2, _1);
    std::printf("%d %d\n", swapped(1, 2), boost::bind(&Derived::get, shared)());
    boost::function<void(const boost::shared_ptr<int const> &)> message = boost::bind(&Derived::take, shared, _1);
    message(boost::make_shared<int>(42));
    std::printf("%d\n", shared->value);
    int value = 1;
    boost::bind(increase, boost::ref(value))();
    boost::function<void()> later = boost::bind(increase, boost::ref(value));
    later();
    std::printf("%d\n", value);
    boost::function<void()> nothing;
    std::printf("%d %d\n", nothing.empty(), !nothing);
    nothing = later;
    std::printf("%d %d\n", nothing.empty(), nothing ? 1 : 0);
    nothing.clear();
    std::printf("%d\n", nothing.empty());
    later = 0;
    std::printf("%d\n", later.empty());
    boost::function1<int, int> older = [](int number) { return -number; };
    std::printf("%d\n", older(4));
    const std::vector<int> numbers{1, 2, 3};
    int                    total = 0;
    for (int number : numbers)
        total += boost::bind<int>([](int a, int b) { return a * b; }, _1, 2)(number);
    std::printf("%d\n", total);
}

static void arrays()
{
    boost::array<double, 3> a = {{1.5, 2.5}};
    boost::array<double, 3> b = a;
    b.assign(4);
    std::printf("%g %g %zu %d %d\n", a[1], a[2], a.size(), a == b, a < b);
    a.swap(b);
    std::printf("%g %g %g\n", a.front(), b.back(), *(b.begin() + 1));
    a.fill(1);
    double total = 0;
    for (boost::array<double, 3>::const_iterator at = a.begin(); at != a.end(); ++at)
        total += *at;
    std::printf("%g %g %zu\n", total, a.c_array()[2], sizeof a);
    boost::array<int, 2> whole = {{1, 2}};
    boost::array<long, 2> wide;
    wide = whole;
    std::printf("%ld %d\n", wide[1], whole.empty());
    try
    {
        whole.at(2) = 1;
    }
    catch (const std::out_of_range &error)
    {
        std::printf("%s\n", error.what());
    }
}

template <class T>
typename boost::enable_if<std::is_integral<T>, const char *>::type kind(T)
{
    return "integer";
}

template <class T>
typename boost::disable_if<std::is_integral<T>, const char *>::type kind(T)
{
    return "other";
}

template <class T>
typename boost::lazy_enable_if_c<sizeof(T) == 1, std::remove_const<T>>::type small(T value)
{
    return value;
}

int main()
{
    pointers();
    callables();
    arrays();
    std::printf("%s %s %c\n", kind(1), kind(1.5), small('x'));
    std::printf("%zu\n", sizeof(boost::uint16_t));
}
