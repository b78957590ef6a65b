"""Makes payloads of Sparkplug B with Google's Python library, after the public specification, independently of the tested program."""
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

F = descriptor_pb2.FieldDescriptorProto


def message(parent, name, *fields):
    m = (parent.nested_type if hasattr(parent, "nested_type") else parent.message_type).add(name=name)
    for field, number, kind, *rest in fields:
        f = m.field.add(name=field, number=number, type=kind, label=rest[0] if rest else F.LABEL_OPTIONAL)
        if kind == F.TYPE_MESSAGE:
            f.type_name = rest[1]
    return m


def payload_class():
    file = descriptor_pb2.FileDescriptorProto(name="spec.proto", package="spec", syntax="proto2")
    payload = message(file, "Payload", ("timestamp", 1, F.TYPE_UINT64), ("metrics", 2, F.TYPE_MESSAGE, F.LABEL_REPEATED, ".spec.Payload.Metric"),
                      ("seq", 3, F.TYPE_UINT64), ("uuid", 4, F.TYPE_STRING), ("body", 5, F.TYPE_BYTES))
    message(payload, "PropertyValue", ("type", 1, F.TYPE_UINT32), ("int_value", 3, F.TYPE_UINT32), ("string_value", 8, F.TYPE_STRING))
    message(payload, "PropertySet", ("keys", 1, F.TYPE_STRING, F.LABEL_REPEATED), ("values", 2, F.TYPE_MESSAGE, F.LABEL_REPEATED, ".spec.Payload.PropertyValue"))
    message(payload, "DataSet", ("num_of_columns", 1, F.TYPE_UINT64), ("columns", 2, F.TYPE_STRING, F.LABEL_REPEATED), ("types", 3, F.TYPE_UINT32, F.LABEL_REPEATED))
    message(payload, "Metric", ("name", 1, F.TYPE_STRING), ("alias", 2, F.TYPE_UINT64), ("timestamp", 3, F.TYPE_UINT64), ("datatype", 4, F.TYPE_UINT32),
            ("is_historical", 5, F.TYPE_BOOL), ("is_transient", 6, F.TYPE_BOOL), ("is_null", 7, F.TYPE_BOOL),
            ("properties", 9, F.TYPE_MESSAGE, F.LABEL_OPTIONAL, ".spec.Payload.PropertySet"), ("int_value", 10, F.TYPE_UINT32), ("long_value", 11, F.TYPE_UINT64),
            ("float_value", 12, F.TYPE_FLOAT), ("double_value", 13, F.TYPE_DOUBLE), ("boolean_value", 14, F.TYPE_BOOL), ("string_value", 15, F.TYPE_STRING),
            ("dataset_value", 17, F.TYPE_MESSAGE, F.LABEL_OPTIONAL, ".spec.Payload.DataSet"))
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    descriptor = pool.FindMessageTypeByName("spec.Payload")
    if hasattr(message_factory, "GetMessageClass"):
        return message_factory.GetMessageClass(descriptor)
    return message_factory.MessageFactory(pool).GetPrototype(descriptor)


Payload = payload_class()


def payload(seq, *metrics):
    """@param metrics  fields of each. @return bytes"""
    p = Payload(timestamp=1_790_000_000_000)
    if seq is not None:
        p.seq = seq
    for fields in metrics:
        p.metrics.add(**fields)
    return p.SerializeToString()
