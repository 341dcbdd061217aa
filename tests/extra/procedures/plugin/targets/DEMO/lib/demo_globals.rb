# Constants of the definitions
$demo_has_spare = true
$demo_counters = 2
def demo_cmd_hdr(target_name, name, code, text)
  return "COMMAND #{target_name} #{name}"
end
