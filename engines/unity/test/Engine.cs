// Stubs of the few things of UnityEngine that the sample calls, in the place of the engine: they compile and draw nothing.
namespace UnityEngine
{
    public class MonoBehaviour { }
    public class Mesh { }
    public class Material { }
    public class Transform { public Vector3 position; }

    public struct RenderParams
    {
        public RenderParams(Material material) { }
    }

    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 up => new Vector3(0, 1, 0);
        public static Vector3 one => new Vector3(1, 1, 1);
        public static Vector3 operator *(Vector3 v, float by) => new Vector3(v.x * by, v.y * by, v.z * by);
    }

    public struct Quaternion
    {
        public static Quaternion AngleAxis(float degrees, Vector3 axis) => new Quaternion();
    }

    public struct Matrix4x4
    {
        public Vector3 Place;
        public static Matrix4x4 TRS(Vector3 place, Quaternion turn, Vector3 scale) => new Matrix4x4 { Place = place };
    }

    public static class Mathf
    {
        public const float Rad2Deg = 57.29578f;
        public static int Min(int a, int b) => a < b ? a : b;
    }

    public static class Graphics
    {
        public static int Drawn;
        public static void RenderMeshInstanced<T>(
            RenderParams parameters, Mesh mesh, int part, T[] places, int count, int from) => Drawn += count;
    }
}
