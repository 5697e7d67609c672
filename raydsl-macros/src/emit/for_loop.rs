//! Emission of `for` loops over ranges and cursors.

use std::collections::HashMap;

use proc_macro2::{Ident, Span, TokenStream};

use super::control::place;
use super::{Dest, Emitter, Loop, own, private, shown};
use crate::here::{At, quote_here as quote, word};
use crate::model::{Block, Expr, Range};

impl Emitter<'_> {
    pub(super) fn for_loop(
        &mut self,
        label: Option<String>,
        var: Option<&Ident>,
        range: &Range,
        body: &Block,
        span: Span,
    ) -> TokenStream {
        let m = own("m");
        let here = place("loop", span);
        let counting = Counting::new(range, ["repeat", "counter", "done"].map(|n| self.fresh(n)));
        let bounds = self.bounds(range);
        let by = self.step_of(range);
        self.scopes.push(HashMap::new());
        let bound = var.map(|name| self.bind_item(name, &counting));
        let Counting { repeat, begin, end, .. } = &counting;
        let inside = Loop { label, ident: repeat.clone(), dest: Dest::None };
        let body = self.loop_body(inside, body);
        self.scopes.pop();
        let counter = counting.declaration(&var.map_or_else(|| "i".to_owned(), shown));
        let (advance, Ending { declare, test, note }) = (counting.advance(), counting.ending());
        let p = private();
        quote! {{
            let (#begin, #end) = #bounds;
            #by
            #counter
            #declare
            let #repeat = #p::Loop::new(#m);
            loop {
                if !#test { break; }
                #here
                #bound
                #body
                #repeat.continuing(#m);
                #note
                #advance;
                if !#repeat.again(#m) { break; }
            }
            #repeat.end(#m);
        }}
    }

    pub(super) fn for_items(
        &mut self,
        label: Option<String>,
        item: &Ident,
        items: &Expr,
        body: &Block,
        span: Span,
    ) -> TokenStream {
        let (p, m, here) = (private(), own("m"), place("loop", span));
        let value = self.value(items);
        let [repeat, cursor, state] = {
            let _at = At::new(items.span);
            ["repeat", "cursor", "state"].map(|n| self.fresh(n))
        };
        self.scopes.push(HashMap::new());
        self.bind_counter(item, None);
        let inside = Loop { label, ident: repeat.clone(), dest: Dest::None };
        let body = self.loop_body(inside, body);
        self.scopes.pop();
        let _at = At::new(items.span);
        quote! {{
            let #cursor = { #value };
            let #state = #p::Cursor::begin(&#cursor, #m);
            let #repeat = #p::Loop::new(#m);
            loop {
                if !#repeat.test(#m, #p::Cursor::advance(&#cursor, #m, &#state)) { break; }
                #here
                let #item = #p::Cursor::item(&#cursor, #m, &#state);
                #body
                #repeat.continuing(#m);
                if !#repeat.again(#m) { break; }
            }
            #repeat.end(#m);
        }}
    }

    /// Emits both bounds, as numbers of one type.
    fn bounds(&mut self, range: &Range) -> TokenStream {
        let (mut start, end) = (self.value(&range.start), self.value(&range.end));
        let _at = At::new(range.start.span);
        let (p, m) = (private(), own("m"));
        if range.start.is_untyped_integer() && range.end.is_untyped_integer() {
            start = quote!(#p::bare(#m, #start));
        }
        quote!(#p::range(#m, { #start }, { #end }))
    }

    /// Emits the variable of an explicit step.
    fn step_of(&mut self, range: &Range) -> Option<TokenStream> {
        let (p, m, by) = (private(), own("m"), own("by"));
        let value = self.value(range.step.as_ref()?);
        Some(quote!(let #by = #p::step(#m, #value);))
    }

    /// Emits the binding of the user's name to the loop's current number.
    fn bind_item(&mut self, name: &Ident, counting: &Counting<'_>) -> TokenStream {
        let step = counting.in_step.map(|_| counting.counter.clone());
        self.bind_counter(name, step);
        let item = counting.item();
        quote!(let #name = #item;)
    }
}

/// The counting of a loop, and the names in its code.
struct Counting<'a> {
    range: &'a Range,
    /// The machine's loop.
    repeat: Ident,
    counter: Ident,
    /// A variable: whether the last number has been used.
    done: Ident,
    /// The bounds, in the order of the source.
    begin: Ident,
    end: Ident,
    /// The number that all rays begin with. They have the same counter while they are in the loop.
    in_step: Option<&'a TokenStream>,
}

/// The termination of a loop.
struct Ending {
    /// Declarations in front of the loop.
    declare: TokenStream,
    /// The test whether there is a further number.
    test: TokenStream,
    /// The update behind the body.
    note: TokenStream,
}

impl<'a> Counting<'a> {
    fn new(range: &'a Range, [repeat, counter, done]: [Ident; 3]) -> Self {
        let goes_up_by_one = !range.reversed && range.step.is_none();
        let in_step = range.start.kind.int_tokens().filter(|_| goes_up_by_one);
        let (begin, end) = (own("begin"), own("end"));
        Self { range, repeat, counter, done, begin, end, in_step }
    }

    fn now(&self) -> TokenStream {
        let (m, counter) = (own("m"), &self.counter);
        quote!(#counter.get(#m))
    }

    /// Returns the bounds of `[low, high)` or `[low, high]`, upwards from `low` or downwards from
    /// `high`.
    fn window(&self) -> (TokenStream, TokenStream) {
        let (begin, end) = (&self.begin, &self.end);
        match self.range.reversed {
            true => (quote!(#begin), self.now()),
            false => (self.now(), quote!(#end)),
        }
    }

    /// Returns the bounds, in the order of counting.
    fn first_and_last(&self) -> (&Ident, &Ident) {
        match self.range.reversed {
            true => (&self.end, &self.begin),
            false => (&self.begin, &self.end),
        }
    }

    /// Emits the number that the body sees.
    fn item(&self) -> TokenStream {
        let (p, m, now) = (private(), own("m"), self.now());
        // Downwards, the counter of an exclusive range is one above the number.
        let is_one_above = self.range.reversed && !self.range.inclusive;
        if is_one_above { quote!(#p::decrement(#m, #now)) } else { now }
    }

    fn declaration(&self, text: &str) -> TokenStream {
        let (p, m, counter) = (private(), own("m"), &self.counter);
        let (first, _) = self.first_and_last();
        match self.in_step {
            Some(from) => {
                quote!(let #counter = #p::Steps::new(#m, #text, #first, #from as u32);)
            }
            None => quote!(let #counter = #p::Var::new(#m, #text, #first);),
        }
    }

    fn advance(&self) -> TokenStream {
        let (p, m, counter, now) = (private(), own("m"), &self.counter, self.now());
        if self.in_step.is_some() {
            return quote!(#counter.advance(#m));
        }
        let next = match &self.range.step {
            Some(_) => {
                let by = own("by");
                quote!(#p::advance(#m, #now, #by))
            }
            None => {
                let next = word(if self.range.reversed { "decrement" } else { "increment" });
                quote!(#p::#next(#m, #now))
            }
        };
        quote!(#counter.set(#m, #next))
    }

    fn ending(&self) -> Ending {
        let (p, m, now) = (private(), own("m"), self.now());
        let (repeat, end, done, counter) = (&self.repeat, &self.end, &self.done, &self.counter);
        let (low, high) = self.window();
        let (_, last) = self.first_and_last();
        let inclusive = self.range.inclusive;
        if self.range.step.is_some() {
            let by = own("by");
            return self.until_done(
                quote!(#p::goes_on_to(#m, #done.get(#m), #low, #high, #inclusive)),
                quote!(#p::is_last(#m, #now, #last, #by, #inclusive)),
            );
        }
        if inclusive {
            return self.until_done(
                quote!(#p::goes_on(#m, #done.get(#m), #low, #high)),
                quote!(#p::equal(#m, #now, #last)),
            );
        }
        let nothing = TokenStream::new;
        if self.in_step.is_some() {
            return Ending {
                declare: quote!(let #end = #p::Stop::new(#m, #end);),
                test: quote!(#end.is_after(#m, &#repeat, &#counter)),
                note: nothing(),
            };
        }
        let test = quote!(#repeat.test(#m, #p::less(#m, #low, #high)));
        Ending { declare: nothing(), test, note: nothing() }
    }

    /// Emits a flag for the end: the last number of an inclusive range, or one with steps, may be
    /// the last of its type.
    fn until_done(&self, test: TokenStream, is_last: TokenStream) -> Ending {
        let (p, m, repeat, done) = (private(), own("m"), &self.repeat, &self.done);
        Ending {
            declare: quote!(let #done = #p::Var::new(#m, "done", #p::Varying::varying(false, #m));),
            test: quote!(#repeat.test(#m, #test)),
            note: quote!(#done.set(#m, #is_last);),
        }
    }
}
