// Whom a buffer of transforms tells of new ones by Boost's signals, as nodes that bring their own tf do. It is there where
// Boost's signals are included before it, which takes the computer's Boost.
#ifndef ROSCFE_FRAMES_CHANGE_SIGNAL_H
#define ROSCFE_FRAMES_CHANGE_SIGNAL_H

#ifdef BOOST_SIGNALS2_HPP

#include "roscfe/frames/buffer.h"

namespace roscfe
{
namespace frames
{

class ChangeSignal : public Buffer::Watcher
{
  public:
    explicit ChangeSignal(Buffer &buffer) : buffer_(buffer) { buffer_.watch(*this); }
    ~ChangeSignal() override { buffer_.watch_no_more(*this); }
    ChangeSignal(const ChangeSignal &) = delete;
    ChangeSignal &operator=(const ChangeSignal &) = delete;

    boost::signals2::signal<void()> signal;

  private:
    void transforms_changed() override { signal(); }

    Buffer &buffer_;
};

} // namespace frames
} // namespace roscfe

#endif
#endif
