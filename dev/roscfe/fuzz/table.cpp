// Tables of parameters that the ground has loaded, where no ROS application keeps them. Each counts as a packet.
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "area.h"
#include "roscfe/node.h"

namespace fuzz
{

namespace
{

class Table final : public Area
{
  public:
    void begin(ros::NodeHandle &node) override
    {
        node_ = &node;
        if (kIsStrict)
        {
            g_flying = true;
            while (g_left > 0)
            {
                work();
            }
        }
    }

    void work() override
    {
        static const char *const kNames[] = {"/a", "/b/c", "/b", "/fuzzed/d", "/", "/b/c/d"};
        const char *             name     = kNames[g_random.below(6)];
        switch (g_random.below(9))
        {
            case 0:
                return get<int>(name);
            case 1:
                return get<double>(name);
            case 2:
                return get<std::string>(name);
            case 3:
                return get<std::vector<int>>(name);
            case 4:
                return get<std::map<std::string, double>>(name);
            case 5:
                return get<XmlRpc::XmlRpcValue>(name);
            case 6:
            {
                std::vector<std::string> names;
                accepted_ += node_->getParamNames(names);
                return;
            }
            case 7:
            {
                std::string found;
                accepted_ += node_->searchParam("c", found) + node_->hasParam(name);
                return;
            }
            default:
                node_->setParam(name, std::string(g_random.below(200), 'x'));
                accepted_ += node_->deleteParam(name);
        }
    }

    void fill() override {}

    bool load(char *table, std::size_t size) override
    {
        static Bytes bytes;
        for (std::size_t at = 0; at + sizeof(roscfe::ParamRow) <= size; at += sizeof(roscfe::ParamRow))
        {
            const Sample &sample = any_sample(); // of a row
            bytes.assign(sample.bytes, sample.size);
            if (g_random.one_in(3))
            {
                damage(bytes);
            }
            std::memcpy(table + at, bytes.at, bytes.size < sizeof(roscfe::ParamRow) ? bytes.size : sizeof(roscfe::ParamRow));
        }
        count(reinterpret_cast<const std::uint8_t *>(table), size);
        return true;
    }

    std::size_t accepted() const override { return accepted_; }

  private:
    template <class T>
    void get(const char *name)
    {
        T value{};
        accepted_ += node_->getParam(name, value);
    }

    ros::NodeHandle *node_     = nullptr;
    std::size_t      accepted_ = 0;
};

} // namespace

Area *make_table()
{
    static Table made;
    return &made;
}

} // namespace fuzz
