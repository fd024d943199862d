//! Arrow arrays as JSON values: what any component holds, by its shape alone.

use rerun::external::arrow::array::{Array, AsArray, ListArray};
use rerun::external::arrow::datatypes::{
    DataType, Float32Type, Float64Type, UInt8Type, UInt32Type,
};
use serde_json::Value;

/// The instances of a component in a row; null where it has none.
pub fn instances(list: &ListArray, row: usize) -> Value {
    if list.is_valid(row) {
        values(list.value(row).as_ref())
    } else {
        Value::Null
    }
}

/// The value with the digits that distinguish it from its neighbours in single precision.
fn shortest(value: f32) -> Value {
    let text = value.to_string().parse::<f64>();
    text.unwrap_or(f64::from(value)).into()
}

/// Any array as JSON; of kinds that Searoom does not write, the name of the kind.
fn values(array: &dyn Array) -> Value {
    let each = |value: &dyn Fn(usize) -> Value| {
        let one = |i| {
            if array.is_valid(i) {
                value(i)
            } else {
                Value::Null
            }
        };
        Value::Array((0..array.len()).map(one).collect())
    };
    match array.data_type() {
        DataType::Float64 => each(&|i| array.as_primitive::<Float64Type>().value(i).into()),
        DataType::Float32 => each(&|i| shortest(array.as_primitive::<Float32Type>().value(i))),
        DataType::UInt32 => each(&|i| array.as_primitive::<UInt32Type>().value(i).into()),
        DataType::UInt8 => each(&|i| array.as_primitive::<UInt8Type>().value(i).into()),
        DataType::Boolean => each(&|i| array.as_boolean().value(i).into()),
        DataType::Utf8 => each(&|i| array.as_string::<i32>().value(i).into()),
        DataType::List(_) => each(&|i| values(array.as_list::<i32>().value(i).as_ref())),
        DataType::FixedSizeList(..) => {
            each(&|i| values(array.as_fixed_size_list().value(i).as_ref()))
        }
        other => {
            let kind = other.to_string();
            each(&|_| Value::String(kind.clone()))
        }
    }
}
