// Classes that a package exports by name. Each shared object is one node and knows its own classes alone.
#ifndef ROSCFE_PLUGINS_H
#define ROSCFE_PLUGINS_H

#include <cstring>

namespace roscfe
{

// The classes of one base, in a list of entries that the linker places: nothing is allocated.
template <class Base>
class Plugins
{
  public:
    struct Entry
    {
        const char *type; // as in the source, such as "my_package::MyNodelet"
        Base *(*make)();
        Entry *next;
    };

    static void add(Entry &entry)
    {
        entry.next = first();
        first()    = &entry;
    }

    // By its type, with or without blanks and leading colons; null when there is none.
    static Base *make(const char *type)
    {
        for (const Entry *entry = first(); entry != nullptr; entry = entry->next)
        {
            if (same(entry->type, type))
            {
                return entry->make();
            }
        }
        return nullptr;
    }

    static Entry *&first()
    {
        static Entry *entries = nullptr;
        return entries;
    }

  private:
    static bool same(const char *one, const char *other)
    {
        for (;;)
        {
            one += std::strspn(one, " ");
            other += std::strspn(other, " ");
            if (*one != *other)
            {
                return false;
            }
            if (*one == '\0')
            {
                return true;
            }
            ++one;
            ++other;
        }
    }
};

} // namespace roscfe

#define ROSCFE_EXPORT_CLASS_(Class, Base, number) ROSCFE_EXPORT_CLASS_NUMBERED_(Class, Base, number)
#define ROSCFE_EXPORT_CLASS_NUMBERED_(Class, Base, number)                                                             \
    namespace                                                                                                          \
    {                                                                                                                  \
    struct RoscfeExported##number                                                                                      \
    {                                                                                                                  \
        RoscfeExported##number()                                                                                       \
        {                                                                                                              \
            static ::roscfe::Plugins<Base>::Entry entry = {#Class, []() -> Base * { return new Class; }, nullptr};     \
            ::roscfe::Plugins<Base>::add(entry);                                                                       \
        }                                                                                                              \
    } g_roscfe_exported##number;                                                                                       \
    }

#endif
