# Cortex-M4, bare metal, GNU toolchain. The firmware calculates in integers, so the floating-point unit stays off.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_BUILD_TYPE MinSizeRel CACHE STRING "-Os, or Release for speed")
# Psabi notes: of a calling convention before GCC 7.
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -mgeneral-regs-only -ffreestanding -ffunction-sections \
-fdata-sections -fno-exceptions -fno-rtti -fno-unwind-tables -fno-asynchronous-unwind-tables -Wno-psabi")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles --specs=nano.specs -Wl,--gc-sections -Wl,--fatal-warnings")
