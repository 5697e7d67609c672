//! glam's swizzles: `v.xy()`, `v.zyx()`, `v.xxyy()`, of vectors of every component.

use super::super::{Machine, X2, X3, X4, vector::Component};
use super::{Method, name};

macro_rules! swizzle {
    (@one $from:ident $to:ident $name:expr; $($c:ident $of:ident)+) => {
        #[diagnostic::do_not_recommend]
        impl<M: Machine, E: Component<M>> Method<{ name($name) }, M, ()> for $from<E> {
            type Output = $to<E>;

            #[inline(always)]
            fn call(self, _: &M, (): ()) -> $to<E> {
                $to { $($c: self.$of),+ }
            }
        }
    };
    // Implements every pair, and every longer swizzle that begins with it.
    (@pairs $from:ident ($($a:ident)+) $all:tt) => {
        $(swizzle!(@second $from $a $all $all);)+
    };
    (@second $from:ident $a:ident ($($b:ident)+) $all:tt) => {
        $(
            swizzle!(@one $from X2 concat!(stringify!($a), stringify!($b)); x $a y $b);
            swizzle!(@third $from $a $b $all $all);
        )+
    };
    (@third $from:ident $a:ident $b:ident ($($c:ident)+) $all:tt) => {
        $(
            swizzle!(@one $from X3 concat!(stringify!($a), stringify!($b), stringify!($c));
                x $a y $b z $c);
            swizzle!(@fourth $from $a $b $c $all);
        )+
    };
    (@fourth $from:ident $a:ident $b:ident $c:ident ($($d:ident)+)) => {
        $(
            swizzle!(@one $from X4
                concat!(stringify!($a), stringify!($b), stringify!($c), stringify!($d));
                x $a y $b z $c w $d);
        )+
    };
}

swizzle!(@pairs X2 (x y) (x y));
swizzle!(@pairs X3 (x y z) (x y z));
swizzle!(@pairs X4 (x y z w) (x y z w));
