// rand() and its kin, a generator of each node's own that begins anew when the node does: what one application draws
// changes nothing for another one. The numbers are those of glibc. The linker puts these functions in the place of C's
// (--wrap).
#include <array>
#include <cstddef>
#include <cstdint>

namespace
{

constexpr std::size_t kDegree     = 31;
constexpr std::size_t kSeparation = 3;
constexpr int         kWarmUp     = 310; // numbers that are drawn and thrown away after a seed

class Generator
{
  public:
    void seed(std::uint32_t seed)
    {
        // By Park and Miller with Schrage's division, whose intermediate results are signed.
        std::int32_t word = static_cast<std::int32_t>(seed == 0 ? 1 : seed);
        for (std::uint32_t &each : state_)
        {
            each                    = static_cast<std::uint32_t>(word);
            const std::int32_t next = 16807 * (word % 127773) - 2836 * (word / 127773);
            word                    = next < 0 ? next + 2147483647 : next;
        }
        at_ = kSeparation;
        for (int i = 0; i < kWarmUp; ++i)
        {
            draw();
        }
        seeded_ = true;
    }

    std::int32_t next()
    {
        if (!seeded_)
        {
            seed(1);
        }
        return static_cast<std::int32_t>(draw() >> 1);
    }

  private:
    // Each number is the sum of those 3 and 31 before it; the ring has the last 31.
    std::uint32_t draw()
    {
        state_[at_] += state_[(at_ + kDegree - kSeparation) % kDegree];
        const std::uint32_t drawn = state_[at_];
        at_                       = (at_ + 1) % kDegree;
        return drawn;
    }

    std::array<std::uint32_t, kDegree> state_{};
    std::size_t                        at_     = 0;
    bool                               seeded_ = false;
};

Generator g_generator;

} // namespace

extern "C" {

int __wrap_rand()
{
    return g_generator.next();
}

long __wrap_random()
{
    return g_generator.next();
}

void __wrap_srand(unsigned int seed)
{
    g_generator.seed(seed);
}

void __wrap_srandom(unsigned int seed)
{
    g_generator.seed(seed);
}

} // extern "C"
