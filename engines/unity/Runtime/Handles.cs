// Handles of the library, which are freed once and never while a call uses them.
using Microsoft.Win32.SafeHandles;

namespace Strew
{
    internal sealed class LibraryHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        private LibraryHandle() : base(true) { }

        protected override bool ReleaseHandle()
        {
            Native.strew_library_free(handle);
            return true;
        }
    }

    internal sealed class PlanHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        private PlanHandle() : base(true) { }

        protected override bool ReleaseHandle()
        {
            Native.strew_plan_free(handle);
            return true;
        }
    }
}
