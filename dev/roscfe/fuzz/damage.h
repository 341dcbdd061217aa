// Random numbers, valid samples, and damage to them: the packets of the fuzz driver. All depends on one seed.
#ifndef DEV_ROSCFE_FUZZ_DAMAGE_H
#define DEV_ROSCFE_FUZZ_DAMAGE_H

#include <cstddef>
#include <cstdint>

namespace fuzz
{

class Random
{
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next(); // splitmix64
    std::size_t   below(std::size_t bound) { return static_cast<std::size_t>(next() % bound); }
    bool          one_in(std::size_t count) { return below(count) == 0; }
    std::uint8_t  byte() { return static_cast<std::uint8_t>(next()); }

  private:
    std::uint64_t state_;
};
extern Random g_random;

constexpr std::size_t kMostBytes = 300000; // of a message: more than nine packets

// Bytes that a sample has, then with faults in them.
struct Bytes
{
    std::uint8_t at[kMostBytes];
    std::size_t  size = 0;

    void assign(const std::uint8_t *from, std::size_t count);
    void append(const void *from, std::size_t count);
    void put32(std::size_t where, std::uint32_t value); // little-endian, as ROS's
    void remove(std::size_t where, std::size_t count);
    void insert(std::size_t where, std::size_t count); // random bytes
};

// A fault: cut, longer, another count, bytes that are missing, bytes too many, changed bits, or nothing but random bytes.
void damage(Bytes &bytes);

// A sample of the corpus: bytes and the MsgId they belong to.
struct Sample
{
    std::uint16_t       msg_id;
    const std::uint8_t *bytes;
    std::size_t         size;
};
void          read_corpus(const char *path);
const Sample &any_sample();
bool          has_sample_of(std::uint16_t msg_id);
const Sample &sample_of(std::uint16_t msg_id); // any of a MsgId, which must have some

// Damage three of four times, sometimes more than once.
void vary(Bytes &bytes);

} // namespace fuzz

#endif
