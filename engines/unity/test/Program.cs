// Runs the wrapper against the real library, and the sample against the stubs of the engine.
using System;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading.Tasks;
using Strew;
using Strew.Samples;
using UnityEngine;

internal static class Program
{
    private static void Expect(bool holds, string what)
    {
        if (holds) return;
        Console.Error.WriteLine("not so: " + what);
        Environment.Exit(1);
    }

    private static void Main()
    {
        Expect(Library.Version.StartsWith("0."), "the version of the library");
        using (var library = new Library())
        {
            Points(library);
            Errors(library);
            Parallel.For(0, 64, i =>
            {
                using (Plan plan = library.Chunk("spacing=2&seed=5", 64, i, -i))
                    Expect(plan.Offsets(out _).Length == 2 * plan.Count, "a chunk in a thread");
            });
        }
        Scene();
        Console.WriteLine("the package has its points");
    }

    private static void Points(Library library)
    {
        const string query = "bbox=100,200,110,210&spacing=1&seed=7&attributes=angle,variant&variants=oak:3,birch:1";
        using (Plan plan = library.Query(query))
        {
            Expect(plan.Count > 80 && plan.Count < 120, "about 100 points and not " + plan.Count);
            double[] xy = plan.Positions();
            float[] offsets = plan.Offsets(out double[] corner);
            Expect(corner[0] == 100 && corner[1] == 200, "the corner of the box");
            for (int i = 0; i < xy.Length; i++)
                Expect(Math.Abs(xy[i] - corner[i % 2] - offsets[i]) < 1e-5, "offsets are positions from the corner");
            Expect(plan.Ids().Length == xy.Length && plan.Numbers("angle").Length == plan.Count, "ids and angles");
            int oaks = 0;
            foreach (int code in plan.Codes("variant")) oaks += code == 1 ? 1 : 0;
            Expect(oaks > plan.Count / 2 && oaks < plan.Count, "more oaks than birches");
            IntPtr memory = Marshal.AllocHGlobal(8 * plan.Count);
            plan.WriteOffsets(memory, 2 * plan.Count);
            var copied = new float[2 * plan.Count];
            Marshal.Copy(memory, copied, 0, copied.Length);
            Marshal.FreeHGlobal(memory);
            Expect(copied[0] == offsets[0] && copied[copied.Length - 1] == offsets[copied.Length - 1], "the same in other memory");
        }
    }

    private static void Errors(Library library)
    {
        try
        {
            library.Query("bbox=0,0,10,10&spacing=-1");
            Expect(false, "a spacing of -1 is refused");
        }
        catch (StrewException error)
        {
            Expect(error.Code == Code.InvalidQuery && error.Kind == "invalid-query", "the code");
            Expect(error.Field == "spacing" && error.Value == "-1", "field and value: " + error.Document);
            Expect(error.Allowed.StartsWith("a number from"), "allowed: " + error.Allowed);
            Expect(error.Message.Contains("`spacing` = `-1`"), "the message: " + error.Message);
        }
        Plan freed = library.Query("bbox=0,0,2,2&spacing=1");
        freed.Dispose();
        freed.Dispose();
        try
        {
            freed.Positions();
            Expect(false, "a plan that is freed is refused");
        }
        catch (ObjectDisposedException) { }
    }

    private static void Scene()
    {
        var forest = new Forest { target = new Transform { position = new Vector3(1000, 0, 500) }, reach = 1 };
        Call(forest, "OnEnable");
        var chunks = (Chunks<Matrix4x4[]>)typeof(Forest).GetField(
            "chunks", BindingFlags.NonPublic | BindingFlags.Instance).GetValue(forest);
        do
        {
            Graphics.Drawn = 0;
            Call(forest, "Update");
        } while (!chunks.IsComplete);
        using (var library = new Library())
        using (Plan plan = library.Query("bbox=960,448,1056,544&" + forest.query))
            Expect(Graphics.Drawn == plan.Count, Graphics.Drawn + " of " + plan.Count + " trees were drawn");
        Call(forest, "OnDisable");
    }

    private static void Call(Forest forest, string name) =>
        typeof(Forest).GetMethod(name, BindingFlags.NonPublic | BindingFlags.Instance).Invoke(forest, null);
}
