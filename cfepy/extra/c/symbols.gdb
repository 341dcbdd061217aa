# Give gdb the symbols of compiled applications as cfepy loads them: gdb -x symbols.gdb --args python -m cfepy run MISSION
#
# cfepy loads shared objects itself, so gdb does not see them. The engine calls cfepy_image_loaded with the name, the
# bytes and the address of each object. A breakpoint there adds its symbols and never stops, so breakpoints in
# applications may be set before the run.
set breakpoint pending on
set confirm off
handle SIG40 nostop noprint pass

python
import atexit, os, shutil, tempfile

REGISTERS = {"i386:x86-64": ("rdi", "rsi", "rdx", "rcx"), "aarch64": ("x0", "x1", "x2", "x3")}


class ImageLoaded(gdb.Breakpoint):
    def __init__(self):
        super().__init__("cfepy_image_loaded", internal=True)
        self.folder = tempfile.mkdtemp(prefix="cfepy-gdb-")
        self.count = 0
        atexit.register(shutil.rmtree, self.folder, True)

    def stop(self):
        frame = gdb.selected_frame()
        name, file, size, base = (int(frame.read_register(each)) & (1 << 64) - 1
                                  for each in REGISTERS[frame.architecture().name()])
        name = os.path.basename(gdb.Value(name).cast(gdb.lookup_type("char").pointer()).string())
        self.count += 1
        path = os.path.join(self.folder, f"{self.count}-{name}")
        with open(path, "wb") as written:
            written.write(gdb.selected_inferior().read_memory(file, size))
        gdb.execute(f"add-symbol-file {path} -o {base:#x}", to_string=True)
        return False


ImageLoaded()
end
