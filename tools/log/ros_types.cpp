// The definitions of ROS's types, as bags contain them.
#include "tools/log/ros_types.h"

namespace maploop::lcm_log {

#define MAPLOOP_ROS_TYPE(name)                                                                   \
  "================================================================================\nMSG: " name \
  "\n"
#define MAPLOOP_ROS_HEADER \
  MAPLOOP_ROS_TYPE("std_msgs/Header") "uint32 seq\ntime stamp\nstring frame_id\n"
#define MAPLOOP_ROS_VECTOR \
  MAPLOOP_ROS_TYPE("geometry_msgs/Vector3") "float64 x\nfloat64 y\nfloat64 z\n"
#define MAPLOOP_ROS_QUATERNION \
  MAPLOOP_ROS_TYPE("geometry_msgs/Quaternion") "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
#define MAPLOOP_ROS_POSE                                                                   \
  MAPLOOP_ROS_TYPE("geometry_msgs/Pose")                                                   \
  "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n" MAPLOOP_ROS_TYPE( \
      "geometry_msgs/Point") "float64 x\nfloat64 y\nfloat64 z\n" MAPLOOP_ROS_QUATERNION

const RosType lcm_message_type{"maploop/LcmMessage", "f43a8e1b362b75baa741461b46adc7e0",
                               "uint8[] data\n"};

const RosType nav_sat_fix_type{
    "sensor_msgs/NavSatFix", "2d3a8cd499b9b4a0249fb98fd05cfa48",
    "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
    "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
    "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
    "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\n"
    "uint8 position_covariance_type\n" MAPLOOP_ROS_HEADER
    MAPLOOP_ROS_TYPE("sensor_msgs/NavSatStatus")
    "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
    "int8 status\nuint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\n"
    "uint16 SERVICE_GALILEO=8\nuint16 service\n"};

const RosType odometry_type{
    "nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7",
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
    "geometry_msgs/TwistWithCovariance twist\n" MAPLOOP_ROS_HEADER
    MAPLOOP_ROS_TYPE("geometry_msgs/PoseWithCovariance")
    "geometry_msgs/Pose pose\nfloat64[36] covariance\n"
    MAPLOOP_ROS_POSE MAPLOOP_ROS_TYPE("geometry_msgs/TwistWithCovariance")
    "geometry_msgs/Twist twist\nfloat64[36] covariance\n"
    MAPLOOP_ROS_TYPE("geometry_msgs/Twist")
    "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n" MAPLOOP_ROS_VECTOR};

const RosType transforms_type{
    "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec",
    "geometry_msgs/TransformStamped[] transforms\n"
    MAPLOOP_ROS_TYPE("geometry_msgs/TransformStamped")
    "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"
    MAPLOOP_ROS_HEADER MAPLOOP_ROS_TYPE("geometry_msgs/Transform")
    "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
    MAPLOOP_ROS_VECTOR MAPLOOP_ROS_QUATERNION};

const RosType compressed_image_type{
    "sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f",
    "std_msgs/Header header\nstring format\nuint8[] data\n" MAPLOOP_ROS_HEADER};

const RosType point_cloud_type{
    "sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181",
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
    "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"
    MAPLOOP_ROS_HEADER MAPLOOP_ROS_TYPE("sensor_msgs/PointField")
    "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
    "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\n"
    "uint32 count\n"};

const RosType markers_type{
    "visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7",
    "visualization_msgs/Marker[] markers\n"
    MAPLOOP_ROS_TYPE("visualization_msgs/Marker")
    "uint8 ARROW=0\nuint8 CUBE=1\nuint8 SPHERE=2\nuint8 CYLINDER=3\nuint8 LINE_STRIP=4\n"
    "uint8 LINE_LIST=5\nuint8 CUBE_LIST=6\nuint8 SPHERE_LIST=7\nuint8 POINTS=8\n"
    "uint8 TEXT_VIEW_FACING=9\nuint8 MESH_RESOURCE=10\nuint8 TRIANGLE_LIST=11\nuint8 ADD=0\n"
    "uint8 MODIFY=0\nuint8 DELETE=2\nuint8 DELETEALL=3\nstd_msgs/Header header\nstring ns\n"
    "int32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
    "std_msgs/ColorRGBA color\nduration lifetime\nbool frame_locked\n"
    "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring text\n"
    "string mesh_resource\nbool mesh_use_embedded_materials\n" MAPLOOP_ROS_HEADER
    MAPLOOP_ROS_POSE MAPLOOP_ROS_VECTOR
    MAPLOOP_ROS_TYPE("std_msgs/ColorRGBA") "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"};

const RosType imu_type{
    "sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2",
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
    "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
    "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
    "float64[9] linear_acceleration_covariance\n" MAPLOOP_ROS_HEADER MAPLOOP_ROS_QUATERNION
        MAPLOOP_ROS_VECTOR};

#undef MAPLOOP_ROS_TYPE
#undef MAPLOOP_ROS_HEADER
#undef MAPLOOP_ROS_VECTOR
#undef MAPLOOP_ROS_QUATERNION
#undef MAPLOOP_ROS_POSE

}  // namespace maploop::lcm_log
